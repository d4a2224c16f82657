"""The task error on any number type: rotations by their vector, without a branch."""

from __future__ import annotations

from flexbase.dynamics.kinematics import Frames
from flexbase.dynamics.task import Target
from flexbase.model.task import Task
from flexbase.trace.algebra import Matrix, Vector, atan2, matmul, minus, norm, or_one, scale, transpose


def rotation_vector(rotation: Matrix) -> Vector:
    """Axis times angle of a rotation matrix [rad]. Loses digits near half a turn, where the axis is found by none."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation
    turn = scale(0.5, (zy - yz, xz - zx, yx - xy))
    sine = norm(turn)
    return scale(atan2(sine, 0.5 * (xx + yy + zz - 1.0)) / or_one(sine), turn)


def tip_error(frames: Frames, task: Task, target: Target) -> Vector:
    """Tip position minus target, and log(R Rd^T) in world axes, the task's rows only: k scalars.

    Assumes one target for all configurations, less than half a turn away.
    """
    full = minus(frames.tool_position, target.position.tolist())
    if any(row >= 3 for row in task.indices):
        wanted = transpose(target.rotation.tolist())
        full = (*full, *rotation_vector(matmul(frames.tool_rotation, wanted)))
    return tuple(full[row] for row in task.indices)
