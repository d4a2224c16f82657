"""Fig. 10: manipulability ellipses over the whole region."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Polygon

from flexbase.checks import Array
from flexbase.report.paper import ring
from flexbase.report.style import BLUE, INK, RED, new_figure, styled
from flexbase.study.paper import EllipseField, RobustnessMap
from flexbase.study.paper.ellipses import RAISE, REACHED, SPACING

MINUS = str.maketrans("-", "−")
LABELS_ELLIPSES = ((0.55, 0.27), (0.12, -0.31), (0.3, 0.38), (-0.02, 0.42))
ELLIPSE_SCALE = 0.095  # m on paper a kg^-1 of semi-axis


@styled()
def ellipses(field: EllipseField, chart: RobustnessMap) -> Figure:
    """Fig. 10: manipulability ellipses without and with a compensator, over the contours of w_1 without."""
    figure = new_figure(6.6, 6.6)
    ax = figure.add_subplot()
    ring.draw_unreachable(ax, chart)
    levels = np.arange(-9, 0) * 0.05
    ax.contourf(
        chart.x, chart.y, chart.robustness, levels=[*levels, 0.0], colors=_tints(len(levels)), zorder=1, extend="min"
    )
    ring.draw_lines(ax, chart, chart.robustness, levels.tolist(), (-0.05, -0.10), LABELS_ELLIPSES, RED)
    ring.draw_robust(ax, chart)
    ring.draw_edges(ax, chart)
    for cell in field.cells:
        place = np.array(cell.tip)
        ax.plot(
            *(place + ELLIPSE_SCALE * cell.original.original.boundary()).T,
            color=INK,
            linewidth=0.8,
            linestyle=(0, (3, 1.5)),
            zorder=5,
        )
        if cell.recursion is None:
            ax.plot(*place, "x", color=RED, markersize=6, markeredgewidth=1.6, zorder=6)
            continue
        outline = Polygon(
            place + ELLIPSE_SCALE * cell.recursion.compensated.boundary(721),
            fill=False,
            edgecolor=INK,
            linewidth=1.2,
            zorder=5,
        )
        ax.add_patch(outline)
        outline.set_clip_path(Circle(cell.tip, 0.5 * SPACING, transform=ax.transData))
    _scale_bar(ax, (-0.36, -0.56), ELLIPSE_SCALE * 1.0, "1 kg$^{-1}$")
    ring.dress(ax)
    figure.legend(handles=_ellipse_legend(field), loc="outside lower center", ncols=2)
    return figure


def _ellipse_legend(field: EllipseField) -> list[Line2D]:
    failed = len(field.cells) - field.count(REACHED)
    return [
        Line2D([], [], color=INK, linewidth=0.8, linestyle=(0, (3, 1.5)), label="original ellipse, |f| ≤ 1 N"),
        Line2D([], [], color=BLUE, linewidth=2.0, label="robust arm configuration, $w_1 = 0$"),
        Line2D([], [], color=INK, linewidth=1.2, label="modified ellipse (long ones cut off)"),
        Line2D([], [], color=RED, linewidth=0.7, label=f"$w_1$ without compensator, every 0.05 {ring.UNIT}"),
        Line2D(
            [],
            [],
            color="none",
            marker="x",
            markeredgecolor=RED,
            markeredgewidth=1.6,
            label=f"$\\omega_1$ + {RAISE:g} rad/s not reached ({failed})",
        ),
        Line2D([], [], color=INK, linewidth=1.8, label="arm singular"),
    ]


def _tints(count: int) -> Array:
    cmap, _ = ring.colours()
    return np.asarray(cmap(np.linspace(0.45, 1.0, count + 1)))


def _scale_bar(ax: Axes, place: tuple[float, float], length: float, text: str) -> None:
    x, y = place
    ax.plot([x, x + length], [y, y], color=INK, linewidth=2.0, solid_capstyle="butt", zorder=7)
    ax.text(
        x + 0.5 * length,
        y + 0.008,
        text,
        ha="center",
        va="bottom",
        fontsize=7.5,
        zorder=7,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
    )
