"""Draw an arm that leaves its plane: equal axes in space, seen from where it spreads most, with its shadow."""

from __future__ import annotations

import numpy as np
from mpl_toolkits.mplot3d.axes3d import Axes3D

from flexbase.checks import Array
from flexbase.model.parts import Parts
from flexbase.plant import Pose
from flexbase.report.arm.in_plane import AXES, base_and_arm, joint_points
from flexbase.report.style import GREY, INK, ORANGE

FLAT = 0.02  # extent out of its plane, of the largest, up to which an arm is drawn in the plane
ELEVATION = 20.0  # of the eye, degrees
ASIDE = 30.0  # turn of the eye away from the arm's broad side, degrees, for depth
ROOM = 0.08  # left around what is drawn, of its size
TICKS = 4  # on each axis


def leaves_plane(pose: Pose, plane: tuple[int, int]) -> bool:
    """Whether an arm's joints and tip lie apart from a plane of two world axes."""
    extent = np.ptp(joint_points(pose), axis=0)
    normal = ({0, 1, 2} - set(plane)).pop()
    return bool(extent[normal] > FLAT * extent.max())


def draw_arm_in_space(
    ax: Axes3D,
    points: Array,
    parts: Parts,
    *,
    color: str = INK,
    alpha: float = 1.0,
    width: float = 2.6,
    joints: bool = True,
) -> None:
    """Links as lines, arm joints as open circles, the base thick; points of shape (N + 1, 3)."""
    base, arm = base_and_arm(points, parts)
    ax.plot(*base.T, color=color, alpha=alpha, linewidth=2.0 * width, solid_capstyle="round")
    ax.plot(*arm.T, color=color, alpha=alpha, linewidth=width, solid_capstyle="round")
    if joints:
        ax.plot(*arm[:-1].T, "o", color=color, markerfacecolor="white", markersize=5.5)


def draw_base_joints(ax: Axes3D, pose: Pose, size: float) -> None:
    """Each base joint by its axis, in orange: a line with two heads where it slides, a ring about it where it turns."""
    places, types = joint_points(pose), pose.arm.mechanism.joint_types
    for i in pose.arm.parts.passive:
        motion = pose.frames.motions[i]
        slides = types[i] == "prismatic"
        axis = np.array(motion.linear if slides else motion.angular, dtype=float)
        if slides:
            for sign in (1.0, -1.0):
                span = sign * size * axis
                ax.quiver(*places[i], *span, color=ORANGE, linewidth=1.8, arrow_length_ratio=0.25)
        else:
            aside = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
            aside /= np.linalg.norm(aside)
            angle = np.linspace(0.0, 2.0 * np.pi, 60)[:, None]
            ring = places[i] + 0.6 * size * (np.cos(angle) * aside + np.sin(angle) * np.cross(axis, aside))
            ax.plot(*ring.T, color=ORANGE, linewidth=1.8)
            ax.plot(*np.array([places[i] - size * axis, places[i] + size * axis]).T, color=ORANGE, linewidth=0.9)
    ax.plot(*places[list(pose.arm.parts.passive)].T, "o", color=INK, markerfacecolor=ORANGE, markersize=7)


def arrow_in_space(ax: Axes3D, start: Array, span: Array, color: str) -> None:
    """An arrow from a point."""
    ax.quiver(*start, *span, color=color, linewidth=1.8, arrow_length_ratio=0.2)


def dress_in_space(ax: Axes3D, rest: Array, drawn: Array) -> None:
    """The eye, equal axes around all points drawn, shape (P, 3), names, and the resting arm's shadow on the floor."""
    low, high = drawn.min(axis=0), drawn.max(axis=0)
    size = float((high - low).max())
    low, high = low - ROOM * size, high + ROOM * size
    ax.plot(rest[:, 0], rest[:, 1], np.full(len(rest), low[2]), color=GREY, linewidth=1.0, alpha=0.6)
    ax.set_xlim(low[0], high[0])
    ax.set_ylim(low[1], high[1])
    ax.set_zlim(low[2], high[2])
    ax.set_box_aspect(tuple((high - low).tolist()), zoom=0.85)
    ax.view_init(elev=ELEVATION, azim=_azimuth(rest))
    for which, name, span in zip((ax.xaxis, ax.yaxis, ax.zaxis), AXES, high - low, strict=True):
        which.set_pane_color((1.0, 1.0, 1.0, 0.0))
        which.set_label_text(f"{name} [m]")
        which.labelpad = 6.0
        which.get_major_locator().set_params(nbins=max(2, round(TICKS * float(span) / float((high - low).max()))))
    ax.tick_params(pad=0)
    ax.grid(True)


def _azimuth(rest: Array) -> float:
    """Where the eye stands [deg]: broadside to the direction in which the arm extends on the floor, a little aside."""
    flat = rest[:, :2] - rest[:, :2].mean(axis=0)
    along = np.linalg.svd(flat)[2][0]
    broadside = np.degrees(np.arctan2(along[1], along[0])) - 90.0 + ASIDE
    return float((broadside + 180.0) % 360.0 - 180.0)
