"""Inverse kinematics of arms with six revolute joints in closed form, and the three signs that name a solution.

Two families are known. In the first, axes 2, 3 and 4 are parallel and axes 5 and 6 meet (UR5e); in the second, axes 4,
5 and 6 meet in one point, and either axes 2 and 3 are parallel or axes 1 and 2 meet (most industrial arms). The point
where the last axes meet is the wrist centre. In both, det J is a product of three factors, and a full pose has up to
eight solutions, one for each triple of their signs.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.dynamics.inverse.subproblems import (
    across,
    angle_between,
    angles_to_height,
    angles_to_length,
    dot,
    turned,
)
from flexbase.dynamics.kinematics import forward
from flexbase.model.mechanism import Mechanism
from flexbase.model.parts import base_first
from flexbase.trace.algebra import stack

CLOSE = 1e-2  # rad, and of the arm's size: so far a calibrated arm may be from its family; Newton steps do the rest
SLACK = 10.0  # cosines may exceed 1 by this many times the distance from the family
ROUNDED = 1e-9  # distance that rounded numbers in a file alone explain


class SixJointArm(NamedTuple):
    """Geometry at zero joint angles with the base at rest, in world axes.

    axes : unit joint axes, shape (6, 3)
    points : a point on each axis, shape (6, 3) [m]; the wrist centre is on axis 5
    parallel : whether axes 2 and 3 are parallel; else axes 1 and 2 meet, in points[0] and points[1]
    wrist : "parallel" if axes 2, 3, 4 are, "spherical" if axes 4, 5, 6 meet
    tool_rotation, tool_position : the tool frame, shapes (3, 3) and (3,)
    distance : by how much the arm departs from its family [rad, or of its size]
    """

    axes: Array
    points: Array
    parallel: bool
    wrist: str
    tool_rotation: Array
    tool_position: Array
    distance: float

    @property
    def centre(self) -> Array:
        """The wrist centre at zero joint angles."""
        return np.asarray(self.points[4])


def six_joint_arm(mechanism: Mechanism, base_rest: Array) -> SixJointArm | None:
    """The arm's geometry, or None where it is of neither family."""
    parts = base_first(len(base_rest), mechanism.N)
    if len(parts.active) != 6 or "prismatic" in parts.arm(mechanism.joint_types):
        return None
    frames = forward(mechanism, parts.whole(tuple(map(float, base_rest)), (0.0,) * 6))
    axes, along = (np.array(part) for part in zip(*parts.arm(frames.motions), strict=True))
    points = np.cross(axes, along)
    tool = np.array(frames.tool_position)
    size = float(np.linalg.norm(points[1:] - points[:-1], axis=1).sum() + np.linalg.norm(tool - points[5])) or 1.0
    skew = [_skew(axes[i], axes[i + 1]) for i in range(5)]
    if skew[4] < 0.1:  # axes 5 and 6 in line: no wrist
        return None
    spherical, gap = _meeting(axes[3:], points[3:])
    meeting, gap_56 = _meeting(axes[4:], points[4:])
    shoulder, gap_12 = _meeting(axes[:2], points[:2]) if skew[0] > 0.1 else (points[0], np.inf)
    families = {
        "parallel": max(skew[1], skew[2], gap_56 / size),
        "spherical": max(gap / size, min(skew[1], gap_12 / size)),
    }
    wrist = min(families, key=lambda name: families[name])
    parallel = wrist == "parallel" or skew[1] <= CLOSE
    if families[wrist] > CLOSE or skew[0] < 0.1 or (wrist == "spherical" and skew[3] < 0.1):
        return None
    points[4] = meeting if wrist == "parallel" else spherical
    if not parallel:
        points[0] = points[1] = shoulder
    distance = families[wrist]
    return SixJointArm(axes, points, parallel, wrist, np.array(stack(frames.tool_rotation)), tool, distance)


def _skew(a: Array, b: Array) -> float:
    """Sine of the angle between two axes."""
    return float(np.linalg.norm(np.cross(a, b)))


def _meeting(axes: Array, points: Array) -> tuple[Array, float]:
    """The point nearest to some axes that are not all parallel, and its distance from the farthest of them."""
    across_each = np.eye(3) - axes[:, :, None] * axes[:, None, :]
    point = np.linalg.lstsq(across_each.sum(axis=0), np.einsum("nij,nj->i", across_each, points), rcond=1e-6)[0]
    return point, float(np.linalg.norm(np.einsum("nij,nj->ni", across_each, point - points), axis=1).max())


def solve_six_joint_arm(arm: SixJointArm, position: Array, rotation: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Eight candidates for each target, shape (T, 8, 6), not wrapped, and whether each exists, shape (T, 8).

    Exact for an arm that is exactly of its family; else starts for Newton steps.

    position, rotation : tool frames, shapes (T, 3) [m] and (T, 3, 3)
    """
    turn = rotation @ arm.tool_rotation.T  # of the last body, from zero joint angles
    centre = position + turn @ (arm.centre - arm.tool_position)
    solved = _with_parallel_axes if arm.wrist == "parallel" else _with_spherical_wrist
    joints, miss = solved(arm, turn, centre)
    full = np.stack(np.broadcast_arrays(*joints), axis=-1).reshape(8, len(centre), 6)
    misses = np.broadcast_to(miss, (2, 2, 2, len(centre))).reshape(8, len(centre))
    exists = (misses <= SLACK * max(arm.distance, ROUNDED)) & np.isfinite(full).all(axis=-1)
    return np.moveaxis(full, 0, 1), np.asarray(np.moveaxis(exists, 0, 1), dtype=bool)


def _apply(matrix: Array, v: Array) -> Array:
    return np.asarray((matrix @ v[..., None])[..., 0])


def _pan(arm: SixJointArm, centre: Array) -> tuple[Array, Array]:
    """The two angles of joint 1 that turn the arm's plane through the wrist centre."""
    h1, h2 = arm.axes[:2]
    offset = dot(h2, arm.centre - arm.points[0])
    return angles_to_height(-h1, h2, centre - arm.points[0], offset)


def _bend(arm: SixJointArm, v: Array, forearm: Array) -> tuple[Array, Array, Array]:
    """Joints 2 and 3 that bring the end of the forearm to v, as seen from the shoulder before joint 2 turns."""
    h2 = arm.axes[1]
    upper, fore, aim = across(h2, arm.points[2] - arm.points[1]), across(h2, forearm), across(h2, v)
    q3, miss = angles_to_length(arm.axes[2], upper, fore, np.linalg.norm(aim, axis=-1))
    return angle_between(h2, upper + turned(arm.axes[2], q3, fore), aim), q3, miss


def _with_parallel_axes(arm: SixJointArm, turn: Array, centre: Array) -> tuple[list[Array], Array]:
    h1, h2, h3, h4, h5, h6 = arm.axes
    p1, p2, _, p4, _, _ = arm.points
    q1, miss1 = _pan(arm, centre)
    last = turned(h1, -q1, _apply(turn, h6))
    q5, miss5 = angles_to_height(h5, h2, h6, dot(h2, last))
    pitch = angle_between(h2, turned(h5, q5, h6), last)
    q6 = _roll(arm, q5, lambda v: turned(h2, -pitch, turned(h1, -q1, _apply(turn, v))))
    v = turned(h1, -q1, centre - p1) - (p2 - p1) - turned(h2, pitch, arm.centre - p4)
    q2, q3, miss3 = _bend(arm, v, p4 - arm.points[2])
    signs = [np.sign(dot(h2, h)) for h in (h3, h4)]
    q4 = signs[1] * (pitch - q2 - signs[0] * q3)
    return [q1, q2, q3, q4, q5, q6], np.maximum(np.maximum(miss1, miss5), miss3)


def _with_spherical_wrist(arm: SixJointArm, turn: Array, centre: Array) -> tuple[list[Array], Array]:
    h1, h2, h3, h4, h5, h6 = arm.axes
    p1, p2, p3 = arm.points[:3]
    if arm.parallel:
        q1, miss1 = _pan(arm, centre)
        q2, q3, miss3 = _bend(arm, turned(h1, -q1, centre - p1) - (p2 - p1), arm.centre - p3)
    else:
        v = centre - p2
        q3, miss3 = angles_to_length(h3, p3 - p2, arm.centre - p3, np.linalg.norm(v, axis=-1))
        arm_vector = p3 - p2 + turned(h3, q3, arm.centre - p3)
        q1, miss1 = angles_to_height(-h1, h2, v, dot(h2, arm_vector))
        q2 = angle_between(h2, arm_vector, turned(h1, -q1, v))

    def left(v: Array) -> Array:
        """What joints 4 to 6 have to do."""
        return turned(h3, -q3, turned(h2, -q2, turned(h1, -q1, _apply(turn, v))))

    last = left(h6)
    q5, miss5 = angles_to_height(h5, h4, h6, dot(h4, last))
    q4 = angle_between(h4, turned(h5, q5, h6), last)
    q6 = _roll(arm, q5, lambda v: turned(h4, -q4, left(v)))
    return [q1, q2, q3, q4, q5, q6], np.maximum(np.maximum(miss1, miss3), miss5)


def _roll(arm: SixJointArm, q5: Array, after_joint_4: Callable[[Array], Array]) -> Array:
    """Joint 6, from what joints 5 and 6 together do to a vector across axis 6."""
    h5, h6 = arm.axes[4:]
    u = np.cross(h5, h6)
    return angle_between(h6, u, turned(h5, -q5, after_joint_4(u)))


def branch_signs(arm: SixJointArm, joints: Array) -> Array:
    """The shoulder, elbow and wrist factors of det J, shape (S, 3) [m, m^2, 1], of joints (S, 6).

    shoulder : (c - p1) . (h1 x h2), how far the wrist centre c is from the plane through axis 1 along axis 2
    elbow : h3 . ((p3 - p2) x (e - p3)), the sine of the angle of joint 3 from the stretched pose, times both lengths;
        e is a point of axis 4 where axes 2, 3, 4 are parallel, else the wrist centre
    wrist : h4 . (h5 x h6), the sine of the angle of joint 5 from where axes 4, 5 and 6 lie in one plane
    Here h_i is the unit axis i in world axes as the joint turns it, and p_i a point on it. The plane and the sine are
    relative to the arm, so each factor depends on joints 2 to 5 only.
    """
    h1, h2, h3, h4, h5, h6 = arm.axes
    p1, p2, p3 = arm.points[:3]
    centre = np.broadcast_to(arm.centre, (len(joints), 3))
    for i in (3, 2, 1):
        centre = arm.points[i] + turned(arm.axes[i], joints[:, i], centre - arm.points[i])
    end = arm.points[3] if arm.wrist == "parallel" else arm.centre
    shoulder = dot(centre - p1, np.cross(h1, h2))
    elbow = dot(np.cross(h3, p3 - p2), turned(h3, joints[:, 2], end - p3))
    wrist = dot(np.cross(h4, h5), turned(h5, joints[:, 4], h6))
    return np.stack([shoulder, elbow, wrist], axis=-1)
