"""The control laws of an ideal run: joint tracking for the move, the task-space law to settle.  [U03 §IV B]"""

from __future__ import annotations

from flexbase.cautions import caution
from flexbase.control.joint_tracking import JointTracking
from flexbase.control.null_space import Law, Sum, self_motion_damping
from flexbase.control.task_pd import TaskPD
from flexbase.control.trajectories import LAWS, JointPath
from flexbase.model.loop import Gain, LoopSpec
from flexbase.plant import Pose
from flexbase.simulation.move import IdealMove
from flexbase.trace.algebra import Scalar, Vector


def moving_law(goal: Pose, start: Vector, switch: Scalar, move: IdealMove) -> JointTracking:
    """Inverse dynamics of the rigid arm along a straight path in joint space, from n arm joints."""
    path = JointPath(start, goal.joints.tolist(), switch, LAWS[move.trajectory])
    return JointTracking(goal, path, move.bandwidth)


def settling_law(goal: Pose, loop: LoopSpec, move: IdealMove) -> Law:
    """Task PD, and for a redundant arm the damping of its self-motion.  [theory §7]"""
    task = TaskPD(goal, loop.gains)
    if goal.arm.n <= goal.arm.k or move.self_motion == 0.0:
        return task
    damping, why = self_motion_damping(goal, Gain(loop.gain), frequency=move.self_motion)
    if why:
        caution(f"{why} The consistent kind is used, without that promise.")
    return Sum(task, damping)
