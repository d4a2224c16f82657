"""Mode shapes of an arm that leaves its plane, one panel a mode."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.axes3d import Axes3D

from flexbase.checks import Array
from flexbase.linear.modal import Mode, Modes
from flexbase.report.arm.in_plane import joint_points
from flexbase.report.arm.in_space import arrow_in_space, draw_arm_in_space, draw_base_joints, dress_in_space
from flexbase.report.arm.mode_signs import MOST, arrows, headline, rigid_headline, signs, swung
from flexbase.report.style import BLUE, GREEN, ORANGE, RED, SKY, new_figure

MARK = 0.2  # of the arm's extent: the drawn size of a base joint's axis
HEADLINE = 0.9  # of the panel's height: inside it, because axes in space leave no room above


def modes_in_space(result: Modes) -> Figure:
    """As `draw_modes`, in axes of three dimensions; the base's joints are drawn by their axes."""
    shown: list[Mode | None] = [*result.modes[:MOST]] or [None]
    columns = min(len(shown), 3)
    rows = -(-len(shown) // columns)
    figure = new_figure(4.4 * columns, 4.9 * rows + 0.3)
    panels, drawn = [], []
    for number, mode in enumerate(shown, start=1):
        ax = figure.add_subplot(rows, columns, number, projection="3d")
        panels.append(ax)
        drawn.append(_panel(ax, result, mode))
        title = rigid_headline(result) if mode is None else headline(number, mode)
        ax.set_title(title, loc="left", fontsize=9, y=HEADLINE)
    for ax in panels:
        dress_in_space(ax, joint_points(result.pose), np.concatenate(drawn))
    if result.modes:
        figure.legend(handles=_signs(result), loc="outside lower center", ncols=3)
    return figure


def _panel(ax: Axes3D, result: Modes, mode: Mode | None) -> Array:
    """Draw one mode, or the resting arm; returns the points that the axes must hold, shape (P, 3)."""
    pose, rest = result.pose, joint_points(result.pose)
    mark = MARK * float(np.ptp(rest, axis=0).max())
    bent = [] if mode is None else swung(pose, mode)
    for points, color in zip(bent, (BLUE, SKY), strict=False):
        draw_arm_in_space(ax, points, pose.arm.parts, color=color, alpha=0.75, width=1.3, joints=False)
    draw_arm_in_space(ax, rest, pose.arm.parts)
    draw_base_joints(ax, pose, mark)
    base = rest[list(pose.arm.parts.passive)]
    drawn = [rest, *bent, base + mark, base - mark]
    if mode is not None and _has_directions(result, mode):
        for span, color in zip(arrows(pose, mode), (RED, GREEN), strict=True):
            arrow_in_space(ax, rest[-1], span, color)
            drawn.append(rest[-1:] + span)
    return np.concatenate(drawn)


def _has_directions(result: Modes, mode: Mode) -> bool:
    return bool(mode.residue.any()) and min(result.pose.arm.task.indices) < 3


def _signs(result: Modes) -> list[Line2D]:
    lines = signs(any(_has_directions(result, mode) for mode in result.modes[:MOST]))
    slides = "prismatic" in result.pose.arm.parts.base(result.pose.arm.mechanism.joint_types)
    name = "base joint: ring turns, arrows slide" if slides else "base joint, turns about its axis"
    return [*lines, Line2D([], [], color=ORANGE, linewidth=1.8, label=name)]
