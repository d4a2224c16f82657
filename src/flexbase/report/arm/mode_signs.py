"""What a picture of a mode shows, in a plane or in space: the swing, the residue's directions, and the words."""

from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from flexbase.checks import Array
from flexbase.linear.modal import Mode, Modes
from flexbase.plant import Pose
from flexbase.report.arm.in_plane import joint_points
from flexbase.report.style import BLUE, GREEN, INK, RED

SWING = 0.12  # of the arm's extent: the largest drawn displacement
ARROW = 0.3  # of the arm's extent
STEP = 1e-6  # rad or m, to see where a mode moves each joint
MOST = 6  # modes drawn


def swung(pose: Pose, mode: Mode) -> list[Array]:
    """The arm displaced by the mode's real part, both ways, so far that it can be seen; none where nothing moves."""
    rest = joint_points(pose)
    shape = np.real(mode.shape)
    speed = (joint_points(pose, pose.q + STEP * shape) - rest) / STEP
    fastest = float(np.linalg.norm(speed, axis=1).max())
    if fastest == 0.0:
        return []
    amplitude = SWING * float(np.ptp(rest, axis=0).max()) / fastest
    return [joint_points(pose, pose.q + sign * amplitude * shape) for sign in (1.0, -1.0)]


def arrows(pose: Pose, mode: Mode) -> tuple[Array, Array]:
    """How the mode moves the tip and what force drives it: the residue's singular vectors in world axes, shape (3,)."""
    left, _, right = np.linalg.svd(mode.residue)
    length, rows = ARROW * float(np.ptp(joint_points(pose), axis=0).max()), pose.arm.task.indices
    spans = [
        length * np.array([vector[rows.index(axis)] if axis in rows else 0.0 for axis in range(3)])
        for vector in (left[:, 0], right[0])
    ]
    return spans[0], spans[1]


def rigid_headline(result: Modes) -> str:
    """What to say over an arm whose base has no joint."""
    return f"{result.pose.plant.name}: rigid base, no vibration mode"


def headline(number: int, mode: Mode) -> str:
    """What to say over a mode."""
    alignment = "undefined" if mode.alignment is None else f"{mode.alignment:.3f}"
    return (
        f"mode {number}: {mode.label}\n"
        f"$\\omega$ = {mode.frequency:.1f} rad/s, $\\zeta$ = {mode.damping_ratio:.2g}, w = {mode.robustness:.3g}\n"
        f"alignment {alignment}"
    ).replace("-", "−")


def signs(directions: bool) -> list[Line2D]:
    """What the lines mean; the residue's arrows where there are any."""
    lines = [
        Line2D([], [], color=INK, linewidth=3.0, label="at rest"),
        Line2D([], [], color=BLUE, linewidth=1.6, label="mode shape, both ways"),
    ]
    if directions:
        lines.insert(1, Line2D([], [], color=RED, linewidth=1.6, label="how the mode moves the tip (a)"))
        lines.append(Line2D([], [], color=GREEN, linewidth=1.6, label="tip force that drives it (b)"))
    return lines
