"""The eleven panels of the paper, one function each: study result -> Figure."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Polygon

from flexbase.checks import Array
from flexbase.report import workspace
from flexbase.report.arm import draw_arm, draw_ground, draw_twist, joint_points
from flexbase.report.style import BLUE, GREY, INK, ORANGE, RED, new_figure, styled
from flexbase.simulate import Run
from flexbase.study.paper import DESIGN_TIP, EllipseField, Example, RobustnessMap, Shaping
from flexbase.study.paper.ellipses import RAISE, REACHED, SPACING

MINUS = str.maketrans("-", "−")
LABELS_WITHOUT = ((0.2, 0.31), (0.25, -0.37), (0.15, 0.37), (0.56, 0.03))  # near the lines w = -0.03 and -0.09
LABELS_WITH = ((-0.22, 0.12), (0.45, -0.31), (0.06, 0.33), (0.25, -0.42))
LABELS_ELLIPSES = ((0.55, 0.27), (0.12, -0.31), (0.3, 0.38), (-0.02, 0.42))
ELLIPSE_SCALE = 0.095  # m on paper a kg^-1 of semi-axis


@styled()
def configuration(case: Example) -> Figure:
    """Fig. 5: the arm with its tip at the work point."""
    figure = new_figure(4.8, 3.65)
    ax = figure.add_subplot()
    points = joint_points(case.pose)[:, :2]
    x, y = DESIGN_TIP
    draw_ground(ax, points[0], 0.03)
    draw_twist(ax, points[0], 0.045)
    draw_arm(ax, points, 1)
    ax.plot(x, y, "s", color=BLUE, markersize=8, zorder=6)
    ax.annotate("work point", (x, y), (x + 0.02, y - 0.035), color=BLUE, ha="left", va="center")
    _dimension(ax, (0.0, -0.34), (x, -0.34), "0.33 m")
    _dimension(ax, (0.5, 0.0), (0.5, y), "0.25 m")
    for line in (
        ((0.0, -0.055), (0.0, -0.355)),
        ((x, -0.27), (x, -0.355)),
        ((0.22, 0.0), (0.515, 0.0)),
        ((0.35, y), (0.515, y)),
    ):
        ax.plot(*zip(*line, strict=True), color=GREY, linewidth=0.6, zorder=1)
    q = np.degrees(case.pose.q)
    ax.annotate("passive joint $q_1$\n(twist of the base)", points[0], (-0.085, 0.075), ha="left", va="bottom")
    for i, shift in enumerate(((0.022, 0.025), (0.012, -0.038))):
        text = f"$q_{i + 2}$ = {q[i + 1]:.1f}°".translate(MINUS)
        ax.annotate(text, points[i + 1], points[i + 1] + np.array(shift), ha="left", va="bottom")
    for i, name in enumerate(("base link", "link 2", "link 3")):
        middle = 0.5 * (points[i] + points[i + 1])
        ax.annotate(
            name,
            middle,
            middle + np.array([(0.0, 0.02), (-0.02, 0.0), (0.02, 0.03)][i]),
            color=GREY,
            ha=["center", "right", "left"][i],
            va="bottom",
        )
    ax.set_aspect("equal")
    ax.set_xlim(-0.14, 0.6)
    ax.set_ylim(-0.38, 0.16)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.legend(
        handles=[
            Line2D(
                [],
                [],
                marker="o",
                color="none",
                markerfacecolor=ORANGE,
                markeredgecolor=INK,
                markersize=8,
                label="passive joint",
            ),
            Line2D(
                [],
                [],
                marker="o",
                color="none",
                markerfacecolor="white",
                markeredgecolor=INK,
                markersize=7,
                label="actuated joint",
            ),
        ],
        loc="upper right",
    )
    return figure


@styled()
def surface(chart: RobustnessMap) -> Figure:
    """Fig. 6a, 8a: w_1 as a surface over the workspace."""
    figure = new_figure(5.8, 4.4)
    ax = figure.add_subplot(projection="3d", computed_zorder=False)
    workspace.draw_surface(ax, chart)
    ax.view_init(elev=38.0, azim=-62.0)
    ax.set_box_aspect((1.0, 1.0, 0.55), zoom=1.12)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.set_zlabel(f"$w_1$ [{workspace.UNIT}]", labelpad=4)
    ax.set_zticks(np.arange(-4, 1) * 0.1)
    _colour_bar(figure, ax, "colours end at −0.30, surface at −0.45", shrink=0.7, pad=0.1)
    keep = workspace.legend_entries(chart, point=False)
    handles = [entry for entry in keep if entry.get_label() not in ("arm singular", "out of reach")]
    figure.legend(handles=handles, loc="outside lower center", ncols=2)
    return figure


@styled()
def contours(chart: RobustnessMap) -> Figure:
    """Fig. 6b, 8b: w_1 as contour lines."""
    figure = new_figure(5.8, 5.4)
    ax = figure.add_subplot()
    workspace.draw_map(ax, chart, LABELS_WITH if chart.compensated else LABELS_WITHOUT)
    _colour_bar(figure, ax, "colours and lines end at −0.30", shrink=0.9, pad=0.02)
    figure.legend(handles=workspace.legend_entries(chart), loc="outside lower center", ncols=2)
    return figure


class Curve(NamedTuple):
    """One of the three curves of Fig. 7: the key in the history, the axis, and the limits of the paper's axis."""

    key: str
    label: str
    limits: tuple[float, float]
    ticks: int


CURVES = {
    "fig07a": Curve("robustness", f"$w_1$ [{workspace.UNIT}]", (-0.1, 0.05), 4),
    "fig07b": Curve("min_eig_modified_inertia", r"$\lambda_{\min}$(M − E) [kg m$^2$]", (0.06, 0.07), 6),
    "fig07c": Curve("frequency_rad_s", r"$\omega_1$ [rad/s]", (250.0, 350.0), 5),
}


def exact_value(shaped: Shaping, key: str) -> float:
    """What the exact design gives for one of the curves of Fig. 7."""
    facts = shaped.exact.certificate
    return {
        "robustness": facts.robustness_after[0],
        "frequency_rad_s": facts.frequency_after_rad_s[0],
        "min_eig_modified_inertia": facts.min_eig_modified_inertia,
    }[key]


@styled()
def iteration_curve(shaped: Shaping, curve: Curve) -> Figure:
    """Fig. 7: one quantity against the iteration of the recursion."""
    figure = new_figure(4.4, 3.0)
    ax = figure.add_subplot()
    ax.plot(
        shaped.iterations,
        shaped.recursion.history[curve.key],
        color=BLUE,
        linewidth=1.8,
        label="recursion, estimated slopes",
    )
    ax.axhline(
        exact_value(shaped, curve.key), color=RED, linewidth=0.9, linestyle=(0, (6, 2)), label="exact design, one solve"
    )
    ax.set_xlim(0, 800)
    ax.set_ylim(*curve.limits)
    ax.set_yticks(np.linspace(*curve.limits, curve.ticks))
    ax.set_xlabel("iteration")
    ax.set_ylabel(curve.label)
    ax.grid(axis="y")
    ax.legend(loc="lower right")
    return figure


@styled()
def positioning_error(run: Run) -> Figure:
    """Fig. 9: the tip's error in x and y, while moving and settling."""
    figure = new_figure(5.2, 3.0)
    ax = figure.add_subplot()
    ax.axhspan(-0.1, 0.1, color="#eaeaea", zorder=0)
    ax.axhline(0.0, color=GREY, linewidth=0.5, zorder=1)
    for column, (name, color, line) in enumerate((("x", BLUE, "-"), ("y", RED, (0, (4, 1.2))))):
        ax.plot(run.t, 1e3 * run.tip_error[:, column], color=color, linestyle=line, linewidth=1.2, label=name)
    ax.axvline(run.switch, color=INK, linewidth=0.9)
    for text, begin, end in (("Move", 0.0, run.switch), ("Settling", run.switch, float(run.t[-1]))):
        ax.annotate(
            "",
            (begin, 2.72),
            (end, 2.72),
            arrowprops={"arrowstyle": "<->", "linewidth": 0.7, "shrinkA": 0, "shrinkB": 0},
        )
        ax.text(0.5 * (begin + end), 2.72, text, ha="center", va="center", backgroundcolor="white")
    ax.set_xlim(0.0, float(run.t[-1]))
    ax.set_ylim(-3.0, 3.0)
    ax.set_xlabel("time [s]")
    ax.set_ylabel(r"positioning error [$10^{-3}$ m]")
    ax.legend(loc="lower right", ncols=2)
    _verdict(ax, run)
    return figure


def _verdict(ax: Axes, run: Run) -> None:
    after = run.settling_time_s
    if after is None:
        last, before = (
            run.error_size[(run.t > run.t[-1] - ago) & (run.t <= run.t[-1] - ago + 0.1)] for ago in (0.1, 0.2)
        )
        text = (
            f"does not settle: up to {1e3 * last.max():.2f} mm in the last 0.1 s,\n"
            f"{1e3 * before.max():.2f} mm in the 0.1 s before\n"
        )
    else:
        moment = run.switch + after
        ax.plot([moment, moment], [-0.9, 0.1], color=INK, linewidth=0.8)
        ax.annotate(
            f"below 0.1 mm (band)\nfrom {1e3 * after:.0f} ms after switching",
            (moment, -0.1),
            (moment + 0.008, -0.95),
            va="center",
        )
        text = ""
    peak = run.peak_error_m
    if peak is not None and peak > 3e-3:
        text += f"(off the scale: {1e3 * peak:.1f} mm right after switching)"
    ax.text(0.5 * (run.switch + run.t[-1]), 2.4, text, ha="center", va="top", fontsize=8, color=INK)


@styled()
def ellipses(field: EllipseField, chart: RobustnessMap) -> Figure:
    """Fig. 10: manipulability ellipses without and with a compensator, over the contours of w_1 without."""
    figure = new_figure(6.6, 6.6)
    ax = figure.add_subplot()
    workspace.draw_unreachable(ax, chart)
    levels = np.arange(-9, 0) * 0.05
    ax.contourf(
        chart.x, chart.y, chart.robustness, levels=[*levels, 0.0], colors=_tints(len(levels)), zorder=1, extend="min"
    )
    workspace.draw_lines(ax, chart, chart.robustness, levels.tolist(), (-0.05, -0.10), LABELS_ELLIPSES, RED)
    workspace.draw_robust(ax, chart)
    workspace.draw_edges(ax, chart)
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
    workspace.dress(ax)
    figure.legend(handles=_ellipse_legend(field), loc="outside lower center", ncols=2)
    return figure


def _ellipse_legend(field: EllipseField) -> list[Line2D]:
    failed = len(field.cells) - field.count(REACHED)
    return [
        Line2D([], [], color=INK, linewidth=0.8, linestyle=(0, (3, 1.5)), label="original ellipse, |f| ≤ 1 N"),
        Line2D([], [], color=BLUE, linewidth=2.0, label="robust arm configuration, $w_1 = 0$"),
        Line2D([], [], color=INK, linewidth=1.2, label="modified ellipse (long ones cut off)"),
        Line2D([], [], color=RED, linewidth=0.7, label=f"$w_1$ without compensator, every 0.05 {workspace.UNIT}"),
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
    cmap, _ = workspace.colours()
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


def _dimension(ax: Axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    ax.annotate("", start, end, arrowprops={"arrowstyle": "<->", "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0})
    ax.text(
        0.5 * (start[0] + end[0]),
        0.5 * (start[1] + end[1]),
        text,
        ha="center",
        va="center",
        rotation=0 if start[1] == end[1] else 90,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
    )


def _colour_bar(figure: Figure, ax: Axes, remark: str, *, shrink: float, pad: float) -> None:
    cmap, norm = workspace.colours()
    bar = figure.colorbar(ScalarMappable(norm, cmap), ax=ax, extend="min", shrink=shrink, pad=pad, aspect=28)
    bar.set_label(f"$w_1$ [{workspace.UNIT}] ({remark})")
