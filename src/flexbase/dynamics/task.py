"""The task coordinates of a configuration, and the error against a target, in batches of NumPy arrays."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from flexbase.checks import Array
from flexbase.dynamics.kinematics import Frames
from flexbase.model.task import Task
from flexbase.trace.algebra import stack


class Target(NamedTuple):
    """A whole tool frame to be reached: position (..., 3) and rotation (..., 3, 3)."""

    position: Array
    rotation: Array


def task_value(frames: Frames, task: Task) -> Array:
    """Tip position and rotation vector, the task's rows only, shape (..., k)."""
    rotation = stack(frames.tool_rotation)
    full = np.concatenate(
        np.broadcast_arrays(stack(frames.tool_position), Rotation.from_matrix(rotation).as_rotvec()), axis=-1
    )
    return np.asarray(full[..., list(task.indices)])


def target_of(frames: Frames) -> Target:
    """The tool frame of a configuration as a target."""
    return Target(stack(frames.tool_position), stack(frames.tool_rotation))


def target_at(task: Task, values: Array) -> Target:
    """The target with these task coordinates, shape (..., k); what the task leaves out counts as zero."""
    full = np.zeros((*values.shape[:-1], 6))
    full[..., list(task.indices)] = values
    return Target(full[..., :3], Rotation.from_rotvec(full[..., 3:]).as_matrix())


def task_error(frames: Frames, task: Task, target: Target) -> Array:
    """Tip position minus target, and log(R Rd^T) in world axes, the task's rows only, shape (..., k)."""
    turned = any(row >= 3 for row in task.indices)
    return tool_error(stack(frames.tool_position), stack(frames.tool_rotation) if turned else None, task, target)


def tool_error(position: Array, rotation: Array | None, task: Task, target: Target) -> Array:
    """`task_error` of a tool frame, shapes (..., 3) and (..., 3, 3); None: a task without rotation rows."""
    away = position - target.position
    if rotation is None or not any(row >= 3 for row in task.indices):
        return np.asarray(away[..., list(task.indices)])
    vector = Rotation.from_matrix(rotation @ np.swapaxes(target.rotation, -1, -2)).as_rotvec()
    return np.asarray(np.concatenate(np.broadcast_arrays(away, vector), axis=-1)[..., list(task.indices)])
