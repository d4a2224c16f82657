"""Draw an arm: links, joints, base, in the plane in which it extends most."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes

from flexbase.checks import Array
from flexbase.dynamics.kinematics import forward
from flexbase.model.parts import Parts
from flexbase.plant import Pose
from flexbase.report.style import INK, ORANGE

AXES = ("x", "y", "z")


def joint_points(pose: Pose, q: Array | None = None) -> Array:
    """World positions of the N joints at q (the pose's own if left out), and of the tip, shape (N + 1, 3) [m]."""
    values = tuple((pose.q if q is None else q).tolist())
    chain, N = pose.arm.mechanism, pose.arm.N
    points = []
    for count in range(N):  # the joint's placement, seen as the tool of the chain before it
        before = replace(
            chain,
            joint_names=chain.joint_names[:count],
            tool_rotation=chain.placement_rotation[count],
            tool_position=chain.placement_position[count],
        )
        points.append(forward(before, values[:count]).tool_position)
    points.append(forward(chain, values).tool_position)
    return np.array(points, dtype=float)


def drawing_plane(pose: Pose) -> tuple[int, int]:
    """The two world axes to draw: the first two positions of the task, or those along which the arm extends most."""
    rows = [row for row in pose.arm.task.indices if row < 3][:2]
    if len(rows) < 2:
        extent = np.ptp(joint_points(pose), axis=0)
        rows += [int(axis) for axis in np.argsort(-extent, kind="stable") if axis not in rows][: 2 - len(rows)]
    return rows[0], rows[1]


def base_and_arm(points: Array, parts: Parts) -> tuple[Array, Array]:
    """Points (N + 1, ...) of the base joints and the first arm joint; and of the arm joints and the tip."""
    return points[[*parts.passive, parts.active[0]]], points[[*parts.active, -1]]


def draw_arm(
    ax: Axes,
    points: Array,
    parts: Parts,
    *,
    color: str = INK,
    alpha: float = 1.0,
    width: float = 3.0,
    joints: bool = True,
) -> None:
    """Links as lines, arm joints as open circles, the base joints filled in orange; points of shape (N + 1, 2)."""
    base, arm = base_and_arm(points, parts)
    ax.plot(*base.T, color=color, alpha=alpha, linewidth=2.2 * width, solid_capstyle="round", zorder=3)
    ax.plot(*arm.T, color=color, alpha=alpha, linewidth=width, solid_capstyle="round", zorder=3)
    if joints:
        ax.plot(*arm[:-1].T, "o", color=color, markerfacecolor="white", markersize=7, alpha=alpha, zorder=5)
        ax.plot(*base[:-1].T, "o", color=color, markerfacecolor=ORANGE, markersize=9, alpha=alpha, zorder=5)


def draw_ground(ax: Axes, place: Array, size: float) -> None:
    """A pivot on hatched ground left of a base joint."""
    x, y = float(place[0]), float(place[1])
    wall = x - 0.9 * size
    ax.plot([x, wall, wall, x], [y, y + 0.6 * size, y - 0.6 * size, y], color=INK, linewidth=1.0, zorder=2)
    ax.fill_between(
        [wall - 0.5 * size, wall],
        y - 1.1 * size,
        y + 1.1 * size,
        facecolor="none",
        edgecolor=INK,
        hatch="/////",
        linewidth=0,
    )
    ax.plot([wall, wall], [y - 1.1 * size, y + 1.1 * size], color=INK, linewidth=1.2, zorder=2)


def draw_twist(ax: Axes, place: Array, radius: float) -> None:
    """A spiral spring about a passive joint."""
    angle = np.linspace(0.5 * np.pi, 4.5 * np.pi, 200)
    r = radius * (0.35 + 0.65 * (angle - angle[0]) / (angle[-1] - angle[0]))
    ax.plot(place[0] + r * np.cos(angle), place[1] + r * np.sin(angle), color=ORANGE, linewidth=1.2, zorder=4)
