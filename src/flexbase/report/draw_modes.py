"""Mode shapes: the arm at rest and at both ends of each vibration, and the directions of its residue."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from flexbase.checks import Array
from flexbase.linear.modal import Mode, Modes
from flexbase.report.arm import AXES, draw_arm, drawing_plane, joint_points
from flexbase.report.style import BLUE, GREEN, INK, RED, SKY, new_figure

SWING = 0.12  # of the arm's extent: the largest drawn displacement
STEP = 1e-6  # rad or m, to see where a mode moves each joint
MOST = 6  # modes drawn


def draw_modes(result: Modes) -> Figure:
    """One panel a mode, softest first; the rigid arm alone where the base has no joint."""
    shown = result.modes[:MOST]
    columns = min(max(len(shown), 1), 3)
    rows = -(-max(len(shown), 1) // columns)
    figure = new_figure(4.4 * columns if columns == 1 else 3.6 * columns, 4.3 * rows)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    plane = drawing_plane(result.pose)
    for ax in axes[max(len(shown), 1) :]:
        ax.set_axis_off()
    for ax in axes[: max(len(shown), 1)]:
        draw_arm(ax, joint_points(result.pose)[:, plane], result.pose.arm.m)
        ax.set_aspect("equal", adjustable="datalim")
        ax.set_xlabel(f"{AXES[plane[0]]} [m]")
        ax.set_ylabel(f"{AXES[plane[1]]} [m]")
        ax.margins(0.12)
    if not shown:
        axes[0].set_title(f"{result.pose.plant.name}: rigid base, no vibration mode", loc="left")
        return figure
    for number, (ax, mode) in enumerate(zip(axes, shown, strict=False), start=1):
        _swing(ax, result, mode, plane)
        _directions(ax, result, mode, plane)
        ax.set_title(_headline(number, mode), loc="left", fontsize=9)
    figure.legend(handles=_signs(result, plane), loc="outside lower center", ncols=2)
    return figure


def _swing(ax: Axes, result: Modes, mode: Mode, plane: tuple[int, int]) -> None:
    """The arm displaced by the mode's real part, both ways, so far that it can be seen."""
    pose = result.pose
    rest = joint_points(pose)
    shape = np.real(mode.shape)
    speed = (joint_points(pose, pose.q + STEP * shape) - rest) / STEP
    fastest = float(np.linalg.norm(speed, axis=1).max())
    if fastest == 0.0:
        return
    amplitude = SWING * float(np.ptp(rest, axis=0).max()) / fastest
    for sign, color in ((1.0, BLUE), (-1.0, SKY)):
        bent = joint_points(pose, pose.q + sign * amplitude * shape)[:, plane]
        draw_arm(ax, bent, pose.arm.m, color=color, alpha=0.75, width=1.4, joints=False)


def _directions(ax: Axes, result: Modes, mode: Mode, plane: tuple[int, int]) -> None:
    """Arrows at the tip along the residue's left and right singular vectors: how the mode moves it, what drives it."""
    pose = result.pose
    if not _has_directions(result, mode, plane):
        return
    left, _, right = np.linalg.svd(mode.residue)
    tip = joint_points(pose)[-1, plane]
    length = 0.3 * float(np.ptp(joint_points(pose), axis=0).max())
    for vector, color in ((left[:, 0], RED), (right[0], GREEN)):
        rows = pose.arm.task.indices
        seen = [vector[rows.index(axis)] if axis in rows else 0.0 for axis in plane]
        _arrow(ax, tip, length * np.array(seen), color)


def _has_directions(result: Modes, mode: Mode, plane: tuple[int, int]) -> bool:
    """Whether the residue has directions that lie in the plane of drawing."""
    return bool(mode.residue.any()) and any(axis in result.pose.arm.task.indices for axis in plane)


def _arrow(ax: Axes, start: Array, span: Array, color: str) -> None:
    tail, head = tuple(start.tolist()), tuple((start + span).tolist())
    look = {"arrowstyle": "-|>", "color": color, "linewidth": 1.6, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", (head[0], head[1]), (tail[0], tail[1]), arrowprops=look, zorder=7)
    ax.plot(*head, alpha=0.0)  # lets the axes grow to hold the arrow


def _headline(number: int, mode: Mode) -> str:
    alignment = "undefined" if mode.alignment is None else f"{mode.alignment:.3f}"
    return (
        f"mode {number}: {mode.label}\n"
        f"$\\omega$ = {mode.frequency:.1f} rad/s, $\\zeta$ = {mode.damping_ratio:.2g}, w = {mode.robustness:.3g}\n"
        f"alignment {alignment}"
    ).replace("-", "−")


def _signs(result: Modes, plane: tuple[int, int]) -> list[Line2D]:
    signs = [
        Line2D([], [], color=INK, linewidth=3.0, label="at rest"),
        Line2D([], [], color=BLUE, linewidth=1.6, label="mode shape, both ways"),
    ]
    if any(_has_directions(result, mode, plane) for mode in result.modes[:MOST]):
        signs.insert(1, Line2D([], [], color=RED, linewidth=1.6, label="how the mode moves the tip (a)"))
        signs.append(Line2D([], [], color=GREEN, linewidth=1.6, label="tip force that drives it (b)"))
    return signs
