"""Draw w_1 over the reachable ring: a contour map and a surface."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from contourpy import FillType, contour_generator
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.contour import ContourSet
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch, Rectangle
from matplotlib.path import Path
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from mpl_toolkits.mplot3d.axes3d import Axes3D

from flexbase.checks import Array
from flexbase.report.style import BLUE, DIVERGING, HATCH, INK
from flexbase.study.paper import DESIGN_TIP, RobustnessMap

WINDOW = (-0.4, 0.8, -0.6, 0.6)  # x and y of the paper's Fig. 6, y extended to all that the tip reaches
SPACING = 0.015  # m/(N s^2) between contour lines  [U03 §IV A]
FLOOR = -0.30  # where colours and lines end
DEPTH = -0.45  # where surfaces are cut
VOID = "#efefef"
UNIT = r"m/(N$\,$s$^2$)"
STEPS = (1, 2)  # rings and spokes a facet of the surface spans


def colours() -> tuple[Colormap, Normalize]:
    """The lower half of a diverging map centred on zero: white is robust, dark red is far from it."""
    full = ScalarMappable(Normalize(-1.0, 1.0), DIVERGING).get_cmap()
    half = LinearSegmentedColormap.from_list("below zero", full(np.linspace(0.0, 0.5, 128)))
    return half, Normalize(FLOOR, 0.0)


def robust_curves(chart: RobustnessMap) -> list[Array]:
    """Robust arm configurations: where the angle from b to a changes sign through zero; curves of shape (P, 2)."""
    doubtful = (np.abs(chart.turn) > 0.5 * np.pi) | ~np.isfinite(chart.turn) | (chart.smallest_inertia <= 0.0)
    found = contour_generator(chart.x, chart.y, np.ma.masked_array(chart.turn, doubtful)).lines(0.0)
    return [np.asarray(line) for line in found]


def indefinite_regions(chart: RobustnessMap) -> list[Array]:
    """Outlines of the regions where M - E is not positive definite, each of shape (P, 2)."""
    filled = contour_generator(chart.x, chart.y, chart.smallest_inertia, fill_type=FillType.OuterOffset)
    points, offsets = filled.filled(-1e9, 0.0)[:2]
    return [np.asarray(p)[: int(np.asarray(o)[1])] for p, o in zip(points, offsets, strict=True)]


def draw_map(ax: Axes, chart: RobustnessMap, label_near: Sequence[tuple[float, float]] | None = None) -> ContourSet:
    """Filled contours, lines every 0.015, the robust arm configurations, and everything that has no value."""
    draw_unreachable(ax, chart)
    cmap, norm = colours()
    w = np.where(chart.smallest_inertia > 0.0, chart.robustness, np.nan)
    w = np.where(np.isnan(w), -1e3, w)  # w falls without bound towards the border of M - E > 0, and is hidden beyond
    levels = np.asarray(np.arange(round(FLOOR / SPACING), 1) * SPACING)
    filled = ax.contourf(chart.x, chart.y, w, levels=levels, cmap=cmap, norm=norm, extend="min", zorder=1.5)
    draw_lines(ax, chart, w, levels[:-1].tolist(), (-0.03, -0.09), label_near)
    if chart.indefinite:
        ax.contourf(
            chart.x, chart.y, chart.smallest_inertia, levels=[-1e3, 0.0], colors=[VOID], hatches=["xxx"], zorder=2.2
        )
        ax.contour(chart.x, chart.y, chart.smallest_inertia, levels=[0.0], colors=[INK], linewidths=0.9, zorder=2.3)
    draw_robust(ax, chart)
    draw_edges(ax, chart)
    ax.plot(*DESIGN_TIP, "*", color="#FFD92F", markeredgecolor=INK, markersize=12, markeredgewidth=0.8, zorder=6)
    dress(ax)
    return filled


def draw_lines(
    ax: Axes,
    chart: RobustnessMap,
    w: Array,
    levels: Sequence[float],
    named: tuple[float, ...],
    label_near: Sequence[tuple[float, float]] | None = None,
    color: str = INK,
) -> None:
    """Contour lines of w, some of them named, at chosen places or wherever there is room."""
    lines = ax.contour(
        chart.x, chart.y, w, levels=levels, colors=[color], linewidths=0.5, linestyles="solid", alpha=0.8, zorder=2
    )
    shown = [level for level in lines.levels if np.isclose(level, named).any()]
    where = {} if label_near is None else {"manual": list(label_near)}
    ax.clabel(lines, shown, fmt=lambda level: f"w = {level:.2f}".replace("-", "−"), fontsize=7, **where)


def draw_robust(ax: Axes, chart: RobustnessMap, color: str = BLUE) -> None:
    """The robust arm configurations, w = 0."""
    for line in robust_curves(chart):
        ax.plot(*line.T, color="white", linewidth=3.4, zorder=3)
        ax.plot(*line.T, color=color, linewidth=2.0, zorder=3.1)


def draw_unreachable(ax: Axes, chart: RobustnessMap) -> None:
    """Hatch the window, and leave the reachable ring white."""
    left, right, low, high = WINDOW
    ax.add_patch(
        Rectangle(
            (left, low), right - left, high - low, facecolor="white", edgecolor=HATCH, hatch="///", lw=0, zorder=0
        )
    )
    circle = Path.circle()
    unit, centre = np.asarray(circle.vertices, dtype=float), np.asarray(chart.shoulder)
    disc = Path(unit * chart.outer + centre, circle.codes)
    hole = Path((unit * chart.inner)[::-1] + centre, circle.codes)
    ax.add_patch(PathPatch(Path.make_compound_path(disc, hole), facecolor="white", edgecolor="none", zorder=0.5))


def draw_edges(ax: Axes, chart: RobustnessMap) -> None:
    """The two circles on which the arm is stretched or folded, and so singular."""
    angle = np.linspace(-np.pi, np.pi, 361)
    for radius in (chart.inner, chart.outer):
        ax.plot(
            chart.shoulder[0] + radius * np.cos(angle),
            chart.shoulder[1] + radius * np.sin(angle),
            color=INK,
            linewidth=1.8,
            zorder=4,
        )


def dress(ax: Axes) -> None:
    """Equal aspect, the window, and axis names."""
    ax.set_aspect("equal")
    ax.set_xlim(*WINDOW[:2])
    ax.set_ylim(*WINDOW[2:])
    ax.set_xticks(np.arange(-2, 5) * 0.2)
    ax.set_yticks(np.arange(-3, 4) * 0.2)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")


def legend_entries(chart: RobustnessMap, *, point: bool = True) -> list[Line2D | Patch]:
    """What the signs on a map mean."""
    entries: list[Line2D | Patch] = [
        Line2D([], [], color=BLUE, linewidth=2.0, label="robust arm configuration, $w_1 = 0$"),
        Line2D([], [], color=INK, linewidth=1.8, label="arm singular"),
        Patch(facecolor="white", edgecolor=HATCH, hatch="///", linewidth=0, label="out of reach"),
    ]
    if chart.indefinite:
        entries.append(
            Patch(facecolor=VOID, edgecolor=HATCH, hatch="xxx", linewidth=0, label="M − E not positive definite")
        )
    if point:
        entries.append(
            Line2D(
                [],
                [],
                marker="*",
                color="none",
                markerfacecolor="#FFD92F",
                markeredgecolor=INK,
                markersize=10,
                label="work point (0.33, −0.25)",
            )
        )
    return entries


def draw_surface(ax: Axes3D, chart: RobustnessMap) -> None:
    """w_1 as facets over the ring, cut at DEPTH; facets without a value lie grey on the floor."""
    cmap, norm = colours()
    rows, columns = (np.arange(0, size, step) for size, step in zip(chart.x.shape, STEPS, strict=True))
    x, y, w, inertia = (
        part[np.ix_(rows, columns)] for part in (chart.x, chart.y, chart.robustness, chart.smallest_inertia)
    )
    corners = [np.stack([x, y, np.clip(np.nan_to_num(w, nan=DEPTH), DEPTH, 0.0)], axis=-1)]
    facets = np.stack([corners[0][i : x.shape[0] - 1 + i, j : x.shape[1] - 1 + j] for i, j in _RING], axis=2)
    sound = np.stack([inertia[i : x.shape[0] - 1 + i, j : x.shape[1] - 1 + j] > 0.0 for i, j in _RING], axis=2).all(2)
    solid = facets[sound]
    paint = cmap(norm(solid[..., 2].mean(axis=1)))
    paint[:, :3] *= _light(solid)[:, None]
    sheet = Poly3DCollection(solid, facecolors=paint, edgecolors=paint, linewidths=0.3)
    sheet.set_rasterized(True)  # tens of thousands of facets: a picture inside the SVG, the rest stays lines
    ax.add_collection3d(sheet)
    void = [np.column_stack([outline, np.full(len(outline), DEPTH)]) for outline in indefinite_regions(chart)]
    if void:
        ax.add_collection3d(
            Poly3DCollection(void, facecolors=VOID, edgecolors=INK, hatch="xxx", linewidths=0.9, zorder=0)
        )
    for line in robust_curves(chart):
        ax.plot(*line.T, 0.0, color=BLUE, linewidth=1.8, zorder=10)
    ax.set_xlim(*WINDOW[:2])
    ax.set_ylim(*WINDOW[2:])
    ax.set_zlim(DEPTH, 0.0)


def _light(facets: Array) -> Array:
    """How bright each facet is under a lamp from the upper left, 0.8 to 1: form without losing the colour."""
    tall = facets * [1.0, 1.0, 1.5]
    normal = np.cross(tall[:, 2] - tall[:, 0], tall[:, 3] - tall[:, 1])
    length = np.linalg.norm(normal, axis=1)
    normal = normal / np.where(length > 0.0, length, 1.0)[:, None]
    lamp = np.array([-0.5, -0.4, 0.77])
    return np.asarray(0.8 + 0.2 * np.abs(normal @ lamp))


_RING = ((0, 0), (1, 0), (1, 1), (0, 1))
