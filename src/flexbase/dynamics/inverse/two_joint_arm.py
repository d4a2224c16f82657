"""Inverse kinematics of two parallel revolute joints in a plane, in closed form, on any number type."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.kinematics import forward
from flexbase.model.mechanism import Mechanism
from flexbase.model.parts import base_first
from flexbase.model.task import Task
from flexbase.trace.algebra import Scalar, atan2, larger, smaller, sqrt


class TwoJointArm(NamedTuple):
    """Geometry in the plane of the task, with the base at rest.

    shoulder : position of the first joint, shape (2,)
    upper, fore : lengths from joint to joint and from joint to tip
    upper_angle, fore_angle : directions of both at zero joint angles
    sense : +1 if the joints turn the first task axis towards the second, else -1
    """

    shoulder: Array
    upper: float
    fore: float
    upper_angle: float
    fore_angle: float
    sense: float


def two_joint_arm(mechanism: Mechanism, task: Task, base_rest: Array) -> TwoJointArm | None:
    """The arm's planar geometry, or None where it is not two parallel joints that move two task positions."""
    parts, rows = base_first(len(base_rest), mechanism.N), task.indices
    kinds = parts.arm(mechanism.joint_types)
    if len(kinds) != 2 or len(rows) != 2 or max(rows) > 2 or "prismatic" in kinds:
        return None
    frames = forward(mechanism, parts.whole(tuple(map(float, base_rest)), (0.0, 0.0)))
    first, second = parts.arm(frames.motions)
    normal = np.cross(np.eye(3)[rows[0]], np.eye(3)[rows[1]])
    axis = np.array(first.angular)
    sense = float(np.sign(axis @ normal))
    if not (np.allclose(axis, sense * normal, atol=1e-12) and np.allclose(axis, second.angular, atol=1e-12)):
        return None
    plane = list(rows)
    shoulder, elbow = (np.cross(axis, joint.linear)[plane] for joint in (first, second))
    upper, fore = elbow - shoulder, np.array(frames.tool_position)[plane] - elbow
    if not (upper.any() and fore.any()):
        return None
    return TwoJointArm(
        shoulder,
        float(np.hypot(*upper)),
        float(np.hypot(*fore)),
        float(np.arctan2(upper[1], upper[0])),
        float(np.arctan2(fore[1], fore[0])),
        sense,
    )


def two_joint_angles(arm: TwoJointArm, x: Scalar, y: Scalar, side: float) -> tuple[Scalar, Scalar, Scalar]:
    """Joint angles that bring the tip to (x, y), the elbow bent to a side of +1 or -1, and the elbow's cosine.

    Out of reach where the cosine leaves [-1, 1]; the angles there are those of the nearest reach.
    """
    dx, dy = x - float(arm.shoulder[0]), y - float(arm.shoulder[1])
    cosine = (dx * dx + dy * dy - (arm.upper**2 + arm.fore**2)) / (2.0 * arm.upper * arm.fore)
    c = larger(smaller(cosine, 1.0), -1.0)
    s = side * sqrt((1.0 - c) * (1.0 + c))
    sine = arm.sense * s
    direction = atan2(dy, dx) - atan2(arm.fore * sine, arm.upper + arm.fore * c)
    first = arm.sense * (direction - arm.upper_angle)
    second = atan2(s, c) - arm.sense * (arm.fore_angle - arm.upper_angle)
    return first, second, cosine


def solve_two_joint_arm(arm: TwoJointArm, x: Array, y: Array, branch: str) -> tuple[Array, Array, Array]:
    """The same for arrays, angles in (-pi, pi]; the branch is the sign of the elbow."""
    first, second, cosine = two_joint_angles(arm, x, y, -1.0 if branch == "-" else 1.0)
    return _wrapped(first), _wrapped(second), np.asarray(cosine)


def _wrapped(angle: Array) -> Array:
    """The same angle in (-pi, pi]."""
    return np.asarray(np.pi - np.mod(np.pi - angle, 2.0 * np.pi))
