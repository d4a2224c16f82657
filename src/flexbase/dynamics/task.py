"""The task coordinates of a configuration, and the error between two of them, in batches of NumPy arrays."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from flexbase.checks import Array
from flexbase.dynamics.kinematics import Frames
from flexbase.model.task import Task
from flexbase.trace.algebra import stack


def task_value(frames: Frames, task: Task) -> Array:
    """Tip position and rotation vector, the task's rows only, shape (..., k)."""
    rotation = stack(frames.tool_rotation)
    full = np.concatenate(
        np.broadcast_arrays(stack(frames.tool_position), Rotation.from_matrix(rotation).as_rotvec()), axis=-1
    )
    return np.asarray(full[..., list(task.indices)])


def task_error(frames: Frames, task: Task, target: Array) -> Array:
    """Tip position minus target, and log(R Rd^T) in world axes, the task's rows only, shape (..., k).

    Rotation rows that the task leaves out count as zero in the target.
    """
    wanted = np.zeros((*target.shape[:-1], 6))
    wanted[..., list(task.indices)] = target
    position = stack(frames.tool_position) - wanted[..., :3]
    if not any(row >= 3 for row in task.indices):
        return np.asarray(position[..., list(task.indices)])
    turned = Rotation.from_matrix(stack(frames.tool_rotation)) * Rotation.from_rotvec(wanted[..., 3:]).inv()
    return np.asarray(
        np.concatenate(np.broadcast_arrays(position, turned.as_rotvec()), axis=-1)[..., list(task.indices)]
    )
