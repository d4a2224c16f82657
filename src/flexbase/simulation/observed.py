"""What a control law may see of a motion: the arm's joints and the tip, never the base."""

from __future__ import annotations

from flexbase.checks import Array
from flexbase.control.measured import Measured
from flexbase.dynamics.kinematics import Frames, forward, task_jacobian
from flexbase.dynamics.task import task_error
from flexbase.model.mounted import MountedArm
from flexbase.plant import Pose
from flexbase.trace.algebra import Scalar, Vector, matvec, unstack


def measured(arm: MountedArm, frames: Frames, time: Scalar, q: Vector, rates: Vector, tip_error: Vector) -> Measured:
    """The part of a state that a controller gets, on any number type; the tip's rate is J q'."""
    tip_rate = matvec(task_jacobian(frames, arm.task.indices), rates)
    return Measured(time, arm.parts.arm(q), arm.parts.arm(rates), tip_error, tip_rate)


def observe(goal: Pose, time: float | Array, q: Array, rates: Array) -> tuple[Frames, Measured]:
    """Where the bodies truly are, and what is measured of it against a goal; one instant or a batch."""
    joints = unstack(q, 1)
    frames = forward(goal.arm.mechanism, joints)
    tip_error = unstack(task_error(frames, goal.arm.task, goal.target), 1)
    return frames, measured(goal.arm, frames, time, joints, unstack(rates, 1), tip_error)
