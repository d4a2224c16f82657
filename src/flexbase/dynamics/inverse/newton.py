"""Damped Newton steps towards tip targets, many rows at once: polish, search and retraction in one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from flexbase.checks import Array
from flexbase.dynamics.kinematics import forward, task_jacobian
from flexbase.dynamics.task import Target, target_at, task_error, task_value
from flexbase.model.mechanism import Mechanism
from flexbase.model.parts import base_first
from flexbase.model.task import Task
from flexbase.trace.algebra import stack, unstack

STEPS = 80
LARGEST_STEP = 0.5  # rad or m, a Newton step
TOLERANCE = 1e-11  # of the arm's reach: rounding in the kinematics is some 1e-15 of it
ROUNDING = 1e-15  # of the arm's reach: no step makes an error smaller than this
STATIONARY = 1e-7  # slope of the error over its length, times the Jacobian: a minimum that is not zero
MOST_DAMPING = 1e3
LEAST_DAMPING = 16.0 * np.finfo(float).eps  # of the trace of J J^T, a row: well above its rounding
BLOCK = 2048  # rows evaluated together: their intermediate arrays stay in the cache


class TipProblem:
    """Residuals of arm joints against tip targets while the base rests, and their slopes.

    Assumes frozen arguments. The residual is the tip error, position and log(R Rd^T) (docs/notation.md). Where one or
    two rotation rows leave the rotation of a freely turning tool open (`open_rotation`), it is instead the rows'
    components of the tool's rotation vector log(R) minus the target's; the other components are then free.

    base_rest : base joints, shape (m,); fixed
    """

    def __init__(self, mechanism: Mechanism, task: Task, base_rest: Array) -> None:
        self.mechanism, self.task = mechanism, task
        self.base = tuple(map(float, base_rest))
        self.parts, self.n = base_first(len(base_rest), mechanism.N), mechanism.N - len(base_rest)
        self.open_rotation = open_rotation(mechanism, task, base_rest)
        self.scale = mechanism.reach
        self.revolute = np.array([kind == "revolute" for kind in self.parts.arm(mechanism.joint_types)])

    def aim(self, targets: Array, rows: int) -> Target:
        """Targets as tool frames, one for each of `rows`."""
        return target_at(self.task, np.broadcast_to(targets, (rows, self.task.k)))

    def residual(self, joints: Array, aim: Target) -> tuple[Array, Array]:
        """Residuals, shape (S, k), and their slopes by the arm joints, shape (S, k, n), of rows of joints (S, n)."""
        parts = [self._residual(joints[i : i + BLOCK], _part(aim, i)) for i in range(0, len(joints), BLOCK)]
        if not parts:
            return np.zeros((0, self.task.k)), np.zeros((0, self.task.k, self.n))
        return np.concatenate([error for error, _ in parts]), np.concatenate([J for _, J in parts])

    def _residual(self, joints: Array, aim: Target) -> tuple[Array, Array]:
        frames = forward(self.mechanism, self.parts.whole(self.base, unstack(joints, 1)))
        if not self.open_rotation:
            J = self.parts.arm(stack(task_jacobian(frames, self.task.indices)))
            return task_error(frames, self.task, aim), np.broadcast_to(J, (len(joints), *J.shape[-2:])).copy()
        rows = list(self.task.indices)
        full = np.broadcast_to(stack(task_jacobian(frames, tuple(range(6)))), (len(joints), 6, self.mechanism.N)).copy()
        vector = Rotation.from_matrix(stack(frames.tool_rotation)).as_rotvec()
        full[:, 3:] = rotation_vector_slope(np.broadcast_to(vector, (len(joints), 3))) @ full[:, 3:]
        wanted = np.concatenate([aim.position, Rotation.from_matrix(aim.rotation).as_rotvec()], axis=-1)[:, rows]
        return task_value(frames, self.task) - wanted, self.parts.arm(full[:, rows])

    def wrapped(self, joints: Array) -> Array:
        """The same joints with the revolute ones in (-pi, pi]."""
        folded = joints.copy()
        folded[:, self.revolute] = np.pi - np.mod(np.pi - joints[:, self.revolute], 2.0 * np.pi)
        return folded


def solve_rows(
    problem: TipProblem, starts: Array, targets: Array, steps: int = STEPS, enough: float = ROUNDING
) -> tuple[Array, Array]:
    """Joints, shape (S, n), revolute ones in (-pi, pi], and remaining errors, shape (S,): best rows of damped steps.

    Levenberg-Marquardt with steps of at most LARGEST_STEP. A row drops out of the batch when its error is small enough,
    or when it stands in a minimum that is not zero.

    starts : shape (S, n); targets : shape (k,) or (S, k)
    enough : error at which a row is done, of the arm's reach
    """
    joints, aim = starts.astype(float), problem.aim(targets, len(starts))
    error, J = problem.residual(joints, aim)
    length, damping = np.linalg.norm(error, axis=1), np.full(len(starts), 1e-3)
    active = np.flatnonzero(length > enough * problem.scale)
    for _ in range(steps):
        if not active.size:
            break
        trial = joints[active] + _step(J[active], error[active], damping[active])
        trial_error, trial_J = problem.residual(trial, Target(aim.position[active], aim.rotation[active]))
        trial_length = np.linalg.norm(trial_error, axis=1)
        better = trial_length < length[active]
        rows = active[better]
        joints[rows], error[rows], J[rows] = trial[better], trial_error[better], trial_J[better]
        length[rows] = trial_length[better]
        damping[active] = np.where(better, damping[active] * 0.1, np.minimum(damping[active] * 10.0, MOST_DAMPING))
        done = _finished(problem.scale, J[active], error[active], length[active], damping[active], better)
        active = active[~done & (length[active] > enough * problem.scale)]
    return problem.wrapped(joints), length


def _step(J: Array, error: Array, damping: Array) -> Array:
    """-J^T (J J^T + damping)^-1 error; never singular, since even the least damping is above the rounding of J J^T."""
    transposed, k = np.swapaxes(J, -1, -2), J.shape[-2]
    gram = J @ transposed
    least = k * LEAST_DAMPING * np.trace(gram, axis1=-2, axis2=-1) + np.finfo(float).tiny
    gram += np.maximum(damping, least)[:, None, None] * np.eye(k)
    step = -(transposed @ np.linalg.solve(gram, error[..., None]))[..., 0]
    return np.asarray(step * np.minimum(1.0, LARGEST_STEP / np.maximum(np.abs(step).max(axis=1), 1e-300))[:, None])


def _finished(
    scale: float, J: Array, error: Array, length: Array, damping: Array, better: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Rows that no further step improves: at rounding, stuck, or in a minimum that is not zero."""
    near = length <= TOLERANCE * scale
    slope = np.linalg.norm((np.swapaxes(J, -1, -2) @ error[..., None])[..., 0], axis=1)
    flat = slope <= STATIONARY * length * np.linalg.norm(J, axis=(1, 2))
    return np.asarray((near & ~better) | (flat & ~near) | (~better & (damping >= MOST_DAMPING)))


def _part(aim: Target, begin: int) -> Target:
    return Target(aim.position[begin : begin + BLOCK], aim.rotation[begin : begin + BLOCK])


def rotation_vector_slope(vector: Array) -> Array:
    """Rate of a rotation vector by the angular velocity in world axes, shape (..., 3, 3), of vectors (..., 3) [rad].

    The inverse of the left Jacobian of the rotation group: 1 - [v]/2 + (1/t^2 - (1 + cos t)/(2 t sin t)) [v]^2.
    """
    angle = np.linalg.norm(vector, axis=-1)
    safe = np.where(angle < 1e-4, 1.0, angle)
    factor = np.where(angle < 1e-4, 1.0 / 12.0, 1.0 / safe**2 - 0.5 / (safe * np.tan(0.5 * safe)))
    cross = np.cross(np.eye(3), vector[..., None, :])
    return np.asarray(np.eye(3) - 0.5 * cross + factor[..., None, None] * (cross @ cross))


def open_rotation(mechanism: Mechanism, task: Task, base_rest: Array) -> bool:
    """Whether one or two rotation rows leave the rotation of the tool open: the arm turns about other axes too."""
    rows = [row for row in task.indices if row >= 3]
    if len(rows) in (0, 3):
        return False
    parts = base_first(len(base_rest), mechanism.N)
    frames = forward(mechanism, parts.whole(tuple(map(float, base_rest)), (0.5,) * len(parts.active)))
    axes = np.array([motion.angular for motion in parts.arm(frames.motions)])
    others = [axis for axis in range(3) if axis + 3 not in rows]
    tool = stack(frames.tool_rotation)
    level = tool[rows[0] - 3, rows[0] - 3] >= 1.0 - 1e-12  # the tool is not tilted about another axis to start with
    return bool(len(rows) == 2 or np.abs(axes[:, others]).max(initial=0.0) > 1e-12 or not level)
