"""From a pose to its linear models: the full second-order system and the reduced form."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexbase.checks import Array, is_definite
from flexbase.errors import InputError
from flexbase.linear.reduced import reduce_arm
from flexbase.linear.second_order import SecondOrder
from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Pose, check_pose

NEGLIGIBLE = 1e-12  # stiffness of the arm, relative, below which it counts as none


class ReducedArrays(NamedTuple):
    """The reduced form of one pose as arrays; see `flexbase.linear.reduced.Reduced`."""

    R0: Array
    U: Array
    V: Array
    S: Array
    W: Array


def has_arm_stiffness(pose: Pose) -> bool:
    """Whether gravity stiffens the arm's own motions."""
    return bool(np.abs(pose.arm.parts.arm(pose.K)).max() > NEGLIGIBLE * np.abs(pose.K).max(initial=0.0))


def has_arm_friction(pose: Pose) -> bool:
    """Whether the arm's joints have viscous friction."""
    return bool(pose.arm.parts.arm(pose.D).any())


def is_reducible(pose: Pose) -> bool:
    """Whether stiffness and damping act on the base alone, so that the reduced form is exact.  [theory §3]"""
    return not (has_arm_stiffness(pose) or has_arm_friction(pose))


def modified_inertia(pose: Pose, E: Array) -> Array:
    """M - blkdiag(0, E), shape (N, N).  [U03 eq 11]"""
    return np.asarray(pose.M - pose.arm.parts.on_arm(E))


def check_definite_inertia(pose: Pose, E: Array) -> Array:
    """M - blkdiag(0, E), positive definite beyond rounding. Raises InputError otherwise."""
    M = modified_inertia(pose, E)
    if not is_definite(M, pose.M):
        smallest = float(np.linalg.eigvalsh(M)[0])
        raise InputError(
            f"compensator: M - E is not positive definite at q = {np.round(pose.q, 4).tolist()} (smallest eigenvalue "
            f"{smallest:.4g}), so the arm would run away. Use it nearer to the pose it was designed for."
        )
    return M


def linearise(pose: Pose, loop: Asked = None) -> SecondOrder:
    """The linear model about a pose: task force f to task displacement y.  [U03 eq 3-4, 11]

    Keeps base damping and stiffness, gravity stiffness and the compensator. Raises InputError if M - E is indefinite.
    """
    check_pose(pose)
    arm = pose.arm
    rows = arm.task.rows
    return SecondOrder(
        M=check_definite_inertia(pose, loop_on(pose.arm, loop).gain),
        D=pose.D,
        K=pose.K,
        B=arm.parts.whole(np.zeros((arm.k, arm.m)), pose.Jv).T,
        C=pose.J,
        joint_names=arm.mechanism.joint_names,
        input_names=tuple(f"f_{row}" for row in rows),
        output_names=rows,
    )


def reduced_arrays(pose: Pose, E: Array) -> ReducedArrays:
    """The reduced form of a pose under the gain E.  [theory §3]"""
    arm = pose.arm
    reduced = reduce_arm(pose.M.tolist(), pose.J.tolist(), arm.parts, E.tolist())
    shapes = ((arm.k, arm.k), (arm.k, arm.m), (arm.k, arm.m), (arm.m, arm.m), (arm.n, arm.m))
    return ReducedArrays(*(np.array(part).reshape(shape) for part, shape in zip(reduced[:5], shapes, strict=True)))
