"""Robust arm configurations as curves, over the joints and in the plane of the tip."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.dynamics.inverse.two_joint_arm import two_joint_arm
from flexbase.report.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, RED, new_figure
from flexbase.study.robust_configurations.curves import RobustCurves

COLORS = (BLUE, RED, GREEN, ORANGE, PURPLE, GREY)


def draw_robust_curves(result: RobustCurves) -> Figure:
    """Left over the two joints, each within a turn; right where the tip is, dashed where the last joint is negative."""
    figure = new_figure(9.4, 4.7)
    left, right = figure.subplots(1, 2)
    arm = result.plant.arm
    names = arm.joint_names
    columns = [names.index(name) for name in result.axes]
    turning = np.array([arm.joint_units[i] == "rad" for i in columns])
    for one in result.curves:
        color = COLORS[(one.mode - 1) % len(COLORS)]
        joints = one.joints[:, columns]
        folded = np.where(turning, np.pi - np.mod(np.pi - joints, 2.0 * np.pi), joints)
        negative = folded[:, 1] < 0.0
        _line(left, folded, _breaks(folded), negative, color)
        _line(right, one.tip, np.zeros(len(joints) - 1, dtype=bool), negative, color)
    kinds = [f"{name} [{'rad' if turns else 'm'}]" for name, turns in zip(result.axes, turning, strict=True)]
    rows = [f"{row} [{unit}]" for row, unit in zip(arm.task.rows, arm.task.units, strict=True)]
    for ax, labels in ((left, kinds), (right, rows)):
        ax.set_xlabel(labels[0])
        ax.set_ylabel(labels[1])
        ax.set_aspect("equal", adjustable="datalim" if ax is right else "box")
        ax.grid(True)
    if turning.all():
        left.set_xlim(-np.pi, np.pi)
        left.set_ylim(-np.pi, np.pi)
    planar = two_joint_arm(arm.mechanism, arm.task, arm.base.equilibrium)
    if planar is not None:
        angle = np.linspace(0.0, 2.0 * np.pi, 361)
        for radius in (abs(planar.upper - planar.fore), planar.upper + planar.fore):
            x, y = planar.shoulder[0] + radius * np.cos(angle), planar.shoulder[1] + radius * np.sin(angle)
            right.plot(x, y, color=INK, linewidth=1.2)
    end = ", compensated" if result.compensated else ""
    left.set_title(f"{result.plant.name}: robust arm configurations{end}", loc="left")
    figure.legend(handles=_signs(result, planar is not None), loc="outside lower center", ncols=5)
    return figure


def _line(ax: Axes, points: Array, breaks: NDArray[np.bool_], negative: NDArray[np.bool_], color: str) -> None:
    """A curve, interrupted at breaks, drawn full where the last joint is positive and dashed elsewhere."""
    for side, dashes in ((~negative, "-"), (negative, (0, (3, 1.5)))):
        drawn = np.where((side | np.r_[side[1:], False] | np.r_[False, side[:-1]])[:, None], points, np.nan)
        if side.any():
            ax.plot(*np.insert(drawn, np.flatnonzero(breaks) + 1, np.nan, axis=0).T, color=color, linestyle=dashes)


def _breaks(points: Array) -> NDArray[np.bool_]:
    """Where a folded curve leaves one side and enters the other."""
    return np.asarray(np.abs(np.diff(points, axis=0)).max(axis=1) > np.pi)


def _signs(result: RobustCurves, edged: bool) -> list[Line2D]:
    modes = sorted({one.mode for one in result.curves})
    signs = [
        Line2D([], [], color=COLORS[(mode - 1) % len(COLORS)], label=f"mode {mode} positive real") for mode in modes
    ]
    signs += [
        Line2D([], [], color=GREY, label=f"{result.axes[1]} > 0"),
        Line2D([], [], color=GREY, linestyle=(0, (3, 1.5)), label=f"{result.axes[1]} < 0"),
    ]
    return signs + ([Line2D([], [], color=INK, linewidth=1.2, label="arm singular")] if edged else [])
