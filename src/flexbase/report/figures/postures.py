"""The best posture for a target beside the one that is taken unasked, and what all postures are worth."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter

from flexbase.report.arm.in_plane import AXES, draw_arm, drawing_plane, joint_points
from flexbase.report.arm.in_space import draw_arm_in_space, draw_base_joints, dress_in_space, leaves_plane
from flexbase.report.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, RED, SKY, in_mathtext, new_figure
from flexbase.study.postures.best_postures import Posture, Postures

MOST = 10  # postures with a row of their own
COLORS = (BLUE, RED, GREEN, ORANGE, PURPLE, SKY)
SPREAD = 0.18  # of a row, between the modes
WIDE = 100.0  # largest over smallest value from which the axis is logarithmic
MARK = 0.2  # of the arm's extent: the drawn size of a base joint's axis


def draw_postures(result: Postures) -> Figure:
    """The arm in its best posture and in the usual one; the measure of every posture, a dot a mode."""
    figure = new_figure(10.0, 4.6)
    best, usual = result.best.pose, result.usual
    others = [(usual.pose, GREY)] if usual else []
    plane = drawing_plane(best)
    if any(leaves_plane(pose, plane) for pose, _ in [(best, INK), *others]):
        ax = figure.add_subplot(1, 2, 1, projection="3d")
        drawn = [joint_points(pose) for pose, _ in [(best, INK), *others]]
        for points, (_, color) in zip(drawn[1:], others, strict=True):
            draw_arm_in_space(ax, points, best.arm.parts, color=color, alpha=0.7, width=1.6, joints=False)
        draw_arm_in_space(ax, drawn[0], best.arm.parts, color=BLUE)
        draw_base_joints(ax, best, MARK * float(np.ptp(drawn[0], axis=0).max()))
        dress_in_space(ax, drawn[0], np.concatenate(drawn))
    else:
        ax = figure.add_subplot(1, 2, 1)
        for pose, color in others:
            draw_arm(ax, joint_points(pose)[:, plane], pose.arm.parts, color=color, alpha=0.7, width=1.8)
        draw_arm(ax, joint_points(best)[:, plane], best.arm.parts, color=BLUE)
        ax.set_aspect("equal", adjustable="datalim")
        ax.margins(0.12)
        ax.set_xlabel(f"{AXES[plane[0]]} [m]")
        ax.set_ylabel(f"{AXES[plane[1]]} [m]")
    signs = [Line2D([], [], color=BLUE, linewidth=3.0, label="best posture")]
    signs += [Line2D([], [], color=GREY, linewidth=2.0, label="taken unasked")] if usual else []
    ax.legend(handles=signs, loc="upper left")
    place = ", ".join(f"{x:.3g}" for x in result.target).replace("-", "−")
    ax.set_title(f"{result.plant.name} at {place}{', compensated' if result.compensated else ''}", loc="left")
    _values(figure.add_subplot(1, 2, 2), result)
    return figure


def _values(ax: Axes, result: Postures) -> None:
    """A row a posture, best on top."""
    shown: list[tuple[str, Posture]] = [
        (f"{one.branch}  {i}".replace("-", "−"), one) for i, one in enumerate(result.found[:MOST], start=1)
    ]
    shown += [("unasked", result.usual)] if result.usual else []
    values = np.array([one.modes for _, one in shown])
    negated = bool((values <= 0.0).all())
    drawn = -values if negated else values
    apart = np.linspace(-SPREAD, SPREAD, drawn.shape[1]) if drawn.shape[1] > 1 else np.zeros(1)
    for mode in range(drawn.shape[1]):
        name = f"mode {mode + 1}" if drawn.shape[1] > 1 else None
        ax.plot(
            drawn[:, mode],
            np.arange(len(shown)) + apart[mode],
            "o",
            color=COLORS[mode],
            markersize=5,
            alpha=0.85,
            label=name,
        )
    if drawn.shape[1] > 1:
        worst = drawn.argmax(axis=1) if negated else drawn.argmin(axis=1)
        rows = np.arange(len(shown))
        ax.plot(
            drawn[rows, worst],
            rows + apart[worst],
            "o",
            color=INK,
            markerfacecolor="none",
            markersize=9,
            label="counts",
        )
        ax.legend(loc="best")
    if (drawn > 0.0).all() and drawn.max() > WIDE * drawn.min():
        ax.set_xscale("log")
        ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_yticks(range(len(shown)), [name for name, _ in shown])
    ax.set_ylim(len(shown) - 0.4, -0.6)
    ax.grid(axis="x")
    unit = "" if result.measure.unit == "1" else f" [{in_mathtext(result.measure.unit)}]"
    meaning = f"; 0: {result.measure.zero_is}" if result.measure.zero_is else ""
    ax.set_xlabel(f"{'−' if negated else ''}{result.measure.name}{unit}{meaning}", fontsize=8)
    ax.set_ylabel("posture, by branch")
    left = len(result.found) - MOST
    ax.set_title("by rising distance from zero" if negated else "best on top", loc="left", fontsize=9)
    if left > 0:
        ax.set_title(f"{left} more not shown", loc="right", fontsize=8, color=GREY)
