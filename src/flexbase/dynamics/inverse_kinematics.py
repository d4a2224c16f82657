"""Inverse kinematics of any serial arm: damped Newton steps from many starts at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.dynamics.kinematics import forward, task_jacobian
from flexbase.dynamics.task import Target, target_at, task_error
from flexbase.dynamics.two_joint_arm import solve_two_joint_arm, two_joint_arm
from flexbase.model.mechanism import Mechanism
from flexbase.model.task import Task
from flexbase.trace.algebra import stack

STARTS = 128
FEW_STARTS = 8
STEPS = 80
LARGEST_STEP = 0.5  # rad or m, a Newton step
STRETCHED = 1.0 + 1e-12  # cosine of the elbow, to rounding, at the edge of reach
TOLERANCE = 1e-11  # of the arm's reach: rounding in the kinematics is some 1e-15 of it


def arm_angles(
    mechanism: Mechanism, task: Task, base_rest: Array, target: Array, branch: str, near: Array | None = None
) -> tuple[Array | None, float]:
    """Arm joints that bring the tip to a target while the base rests, and the smallest tip error that was found.

    The branch is the sign of the elbow (`elbow_of`). Of several solutions the one nearest to `near` is taken; without
    it the one nearest to zero, or for redundant arms the best conditioned. None where no start arrives.
    """
    planar = two_joint_arm(mechanism, task, base_rest)
    if planar is not None:
        first, second, cosine = solve_two_joint_arm(planar, target[0], target[1], branch)
        reached = abs(float(cosine)) <= STRETCHED
        distance = float(np.hypot(*(target - planar.shoulder)))
        shortfall = max(distance - planar.upper - planar.fore, abs(planar.upper - planar.fore) - distance, 0.0)
        return (np.array([first, second]), 0.0) if reached else (None, shortfall)
    starts = _starts(mechanism, len(base_rest), branch, near)
    found, errors = newton(mechanism, task, base_rest, starts, target)
    good = (errors <= TOLERANCE * reach(mechanism)) & _on_branch(mechanism, len(base_rest), found, branch)
    if not good.any():
        return None, float(errors.min())
    if near is None and found.shape[1] > task.k:
        return found[good][np.argmax(_conditioning(mechanism, task, base_rest, found[good]))], 0.0
    centre = np.zeros(found.shape[1]) if near is None else near
    return found[good][np.argmin(np.linalg.norm(found[good] - centre, axis=1))], 0.0


def elbow_of(n: int) -> int | None:
    """Which arm joint is the elbow: the fourth of seven, the third of six, the second of fewer, none of one."""
    return None if n < 2 else {6: 2, 7: 3}.get(n, 1)


def _conditioning(mechanism: Mechanism, task: Task, base_rest: Array, joints: Array) -> Array:
    """Smallest over largest singular value of Jv, for each row of joints."""
    frames = forward(mechanism, (*map(float, base_rest), *joints.T))
    values = np.linalg.svd(stack(task_jacobian(frames, task.indices))[..., len(base_rest) :], compute_uv=False)
    return np.asarray(values[..., -1] / values[..., 0])


def arm_angles_of_many(
    mechanism: Mechanism, task: Task, base_rest: Array, targets: Array, branch: str
) -> tuple[Array, NDArray[np.bool_]]:
    """Arm joints for many targets, shape (T, k), and whether each is reached, shape (T,).

    In closed form for two parallel joints; other arms by Newton steps from `FEW_STARTS` starts, the first to arrive.
    """
    planar = two_joint_arm(mechanism, task, base_rest)
    if planar is not None:
        first, second, cosine = solve_two_joint_arm(planar, targets[:, 0], targets[:, 1], branch)
        return np.column_stack([first, second]), np.abs(cosine) <= STRETCHED
    joints = np.zeros((len(targets), mechanism.N - len(base_rest)))
    reached = np.zeros(len(targets), dtype=bool)
    for start in _starts(mechanism, len(base_rest), branch, None)[1 : FEW_STARTS + 1]:
        open_cells = np.flatnonzero(~reached)
        starts = np.tile(start, (len(open_cells), 1))
        found, errors = newton(mechanism, task, base_rest, starts, targets[open_cells])
        good = (errors <= TOLERANCE * reach(mechanism)) & _on_branch(mechanism, len(base_rest), found, branch)
        joints[open_cells[good]], reached[open_cells[good]] = found[good], True
    return joints, reached


def _on_branch(mechanism: Mechanism, m: int, joints: Array, branch: str) -> NDArray[np.bool_]:
    """Whether the elbow is bent to the asked side; True where there is none, or it slides."""
    elbow = elbow_of(joints.shape[1])
    if elbow is None or mechanism.joint_types[m + elbow] != "revolute":
        return np.ones(len(joints), dtype=bool)
    return np.array((np.sin(joints[:, elbow]) >= 0.0) == (branch == "+"))


def newton(mechanism: Mechanism, task: Task, base_rest: Array, starts: Array, target: Array) -> tuple[Array, Array]:
    """Improve every row of `starts`, shape (S, n), towards one target or a target each; joints and remaining errors."""
    m = len(base_rest)
    revolute = np.array([kind == "revolute" for kind in mechanism.joint_types[m:]])
    joints = starts.copy()
    aim = target_at(task, np.broadcast_to(target, (len(starts), task.k)))
    damping = np.full((len(starts), 1, 1), 1e-3)
    error, J = _error_and_jacobian(mechanism, task, base_rest, joints, aim)
    for _ in range(STEPS):
        gram = J @ np.swapaxes(J, -1, -2) + damping * np.eye(task.k)
        step = -(np.swapaxes(J, -1, -2) @ np.linalg.solve(gram, error[..., None]))[..., 0]
        step *= np.minimum(1.0, LARGEST_STEP / np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-300))
        trial = joints + step
        trial_error, trial_J = _error_and_jacobian(mechanism, task, base_rest, trial, aim)
        better = np.linalg.norm(trial_error, axis=1) < np.linalg.norm(error, axis=1)
        joints[better], error[better], J[better] = trial[better], trial_error[better], trial_J[better]
        damping = np.where(better[:, None, None], damping * 0.1, np.minimum(damping * 10.0, 1e3))
    joints[:, revolute] = np.pi - np.mod(np.pi - joints[:, revolute], 2.0 * np.pi)
    return joints, np.linalg.norm(error, axis=1)


def _error_and_jacobian(
    mechanism: Mechanism, task: Task, base_rest: Array, joints: Array, target: Target
) -> tuple[Array, Array]:
    frames = forward(mechanism, (*map(float, base_rest), *joints.T))
    J = stack(task_jacobian(frames, task.indices))[..., len(base_rest) :]
    return task_error(frames, task, target), np.array(np.broadcast_to(J, (len(joints), *J.shape[-2:])))


def _starts(mechanism: Mechanism, m: int, branch: str, near: Array | None) -> Array:
    """Low-discrepancy starts over the arm's joints, the elbow on the asked side; the first is `near`."""
    from scipy.stats import qmc  # half a second to import, and only arms without a closed form need it

    n = mechanism.N - m
    unit = qmc.Halton(n, scramble=False).random(STARTS)
    span = np.array([np.pi if kind == "revolute" else reach(mechanism) for kind in mechanism.joint_types[m:]])
    starts = (2.0 * unit - 1.0) * span
    elbow = elbow_of(n)
    if elbow is not None:
        starts[:, elbow] = np.abs(starts[:, elbow]) * (1.0 if branch == "+" else -1.0)
    if near is not None:
        starts[0] = near
    return np.asarray(starts)


def reach(mechanism: Mechanism) -> float:
    """Sum of all link offsets: no tip is farther out while prismatic joints stand at zero."""
    offsets = np.linalg.norm(mechanism.placement_position, axis=1).sum()
    return float(offsets + np.linalg.norm(mechanism.tool_position)) or 1.0
