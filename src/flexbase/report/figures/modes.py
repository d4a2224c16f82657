"""Mode shapes: the arm at rest and at both ends of each vibration, and the directions of its residue."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from flexbase.checks import Array
from flexbase.linear.modal import Mode, Modes
from flexbase.report.arm.in_plane import AXES, draw_arm, drawing_plane, joint_points
from flexbase.report.arm.in_space import leaves_plane
from flexbase.report.arm.mode_signs import MOST, arrows, headline, rigid_headline, signs, swung
from flexbase.report.arm.modes_in_space import modes_in_space
from flexbase.report.style import BLUE, GREEN, RED, SKY, new_figure


def draw_modes(result: Modes) -> Figure:
    """One panel a mode, softest first; the rigid arm alone where the base has no joint. In space where it needs to."""
    plane = drawing_plane(result.pose)
    return modes_in_space(result) if leaves_plane(result.pose, plane) else _modes_in_plane(result, plane)


def _modes_in_plane(result: Modes, plane: tuple[int, int]) -> Figure:
    shown = result.modes[:MOST]
    columns = min(max(len(shown), 1), 3)
    rows = -(-max(len(shown), 1) // columns)
    figure = new_figure(4.4 * columns if columns == 1 else 3.6 * columns, 4.3 * rows)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for ax in axes[max(len(shown), 1) :]:
        ax.set_axis_off()
    for ax in axes[: max(len(shown), 1)]:
        draw_arm(ax, joint_points(result.pose)[:, plane], result.pose.arm.parts)
        ax.set_aspect("equal", adjustable="datalim")
        ax.set_xlabel(f"{AXES[plane[0]]} [m]")
        ax.set_ylabel(f"{AXES[plane[1]]} [m]")
        ax.margins(0.12)
    if not shown:
        axes[0].set_title(rigid_headline(result), loc="left")
        return figure
    for number, (ax, mode) in enumerate(zip(axes, shown, strict=False), start=1):
        _swing(ax, result, mode, plane)
        _directions(ax, result, mode, plane)
        ax.set_title(headline(number, mode), loc="left", fontsize=9)
    figure.legend(handles=_signs(result, plane), loc="outside lower center", ncols=2)
    return figure


def _swing(ax: Axes, result: Modes, mode: Mode, plane: tuple[int, int]) -> None:
    for bent, color in zip(swung(result.pose, mode), (BLUE, SKY), strict=False):
        draw_arm(ax, bent[:, plane], result.pose.arm.parts, color=color, alpha=0.75, width=1.4, joints=False)


def _directions(ax: Axes, result: Modes, mode: Mode, plane: tuple[int, int]) -> None:
    """Arrows at the tip along the residue's left and right singular vectors: how the mode moves it, what drives it."""
    pose = result.pose
    if not _has_directions(result, mode, plane):
        return
    tip = joint_points(pose)[-1, plane]
    for span, color in zip(arrows(pose, mode), (RED, GREEN), strict=True):
        _arrow(ax, tip, span[list(plane)], color)


def _has_directions(result: Modes, mode: Mode, plane: tuple[int, int]) -> bool:
    """Whether the residue has directions that lie in the plane of drawing."""
    return bool(mode.residue.any()) and any(axis in result.pose.arm.task.indices for axis in plane)


def _arrow(ax: Axes, start: Array, span: Array, color: str) -> None:
    tail, head = tuple(start.tolist()), tuple((start + span).tolist())
    look = {"arrowstyle": "-|>", "color": color, "linewidth": 1.6, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", (head[0], head[1]), (tail[0], tail[1]), arrowprops=look, zorder=7)
    ax.plot(*head, alpha=0.0)  # lets the axes grow to hold the arrow


def _signs(result: Modes, plane: tuple[int, int]) -> list[Line2D]:
    return signs(any(_has_directions(result, mode, plane) for mode in result.modes[:MOST]))
