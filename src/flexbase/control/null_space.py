"""Control of a redundant arm's self-motion that passivity covers together with the task's.  [theory §7]

With tau = Jv^T f + W^T g the base couples f and g. Two choices of W keep any passive pair of controls stable:

- blind, W Y Map = 0: the self-motion port neither drives nor sees the base. It exists where the tip forces reach every
  base motion that the arm torques reach (rank V = rank Map, so m <= k), and suits every positive real plant.
- consistent, W Y Jv^T = 0: it exists everywhere and needs V = beta Jp with one beta outside [0, 1]. The pair's response
  is then diag(R0, W Y W^T)/s + s [(beta - 1) Jp; W Y Map] Z(s)^-1 [beta Jp; W Y Map]^T, which is positive real once the
  second output is weighted by (beta - 1)/beta > 0, and a weight changes no verdict on two separate feedbacks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from flexbase.checks import Array, positive_number
from flexbase.control.measured import Measured
from flexbase.errors import Infeasible, InputError
from flexbase.linear.second_order import SecondOrder
from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Pose, check_pose
from flexbase.trace.algebra import Vector, matvec, minus, plus, scale, transpose

FELT = 1e-4  # cosine between a base motion, as arm torques drive it, and tip forces, below which it is not felt
ONE_BETA = 1e-6  # relative residual of V = beta Jp up to which all modes count as sharing one beta
KINDS = ("blind", "consistent")


class Law(Protocol):
    """A control law: torques from what is measured."""

    def torque(self, seen: Measured) -> Vector:
        """Arm torques, n scalars (or batches)."""
        ...


@dataclass(frozen=True, eq=False)
class NullSpaceDamping:
    """tau = -W^T (stiffness W (q_a - goal) + damping W q_a').  [theory §7]

    W : self-motion coordinates, shape (n - k, n)
    stiffness, damping : symmetric, shape (n - k, n - k)
    """

    goal: Pose
    W: Array
    stiffness: Array
    damping: Array

    def torque(self, seen: Measured) -> Vector:
        """Arm torques, n scalars (or batches)."""
        rows = tuple(map(tuple, self.W.tolist()))
        offset = matvec(rows, minus(seen.joints, self.goal.joints.tolist()))
        pull = plus(matvec(self.stiffness.tolist(), offset), matvec(self.damping.tolist(), matvec(rows, seen.rates)))
        return scale(-1.0, matvec(transpose(rows), pull))

    def close(self, system: SecondOrder) -> SecondOrder:
        """The linear model with this torque fed back, still second order."""
        springs, dampers = (
            self.goal.arm.parts.on_arm(self.W.T @ gain @ self.W) for gain in (self.stiffness, self.damping)
        )
        return replace(system, K=system.K + springs, D=system.D + dampers)


@dataclass(frozen=True)
class Sum:
    """Two laws at once: the task's and the self-motion's."""

    one: Law
    other: Law

    def torque(self, seen: Measured) -> Vector:
        """Arm torques, n scalars (or batches)."""
        return plus(self.one.torque(seen), self.other.torque(seen))


def null_space_damping(
    pose: Pose,
    loop: Asked = None,
    *,
    frequency: float,
    damping_ratio: float = 0.7,
    kind: str | None = None,
) -> NullSpaceDamping:
    """Self-motion control at one pose and under one compensator, stable with it at any gain if the plant is passive.

    Assumes n > k. See the module for the two kinds.

    frequency, damping_ratio : of the self-motion by itself, its inertia being that of M - E [rad/s, 1]
    kind : "blind" or "consistent"; left out, consistent where V = beta Jp holds, else blind
    Raises InputError for an arm that is not redundant, Infeasible where the kind does not exist or does not help.
    """
    check_pose(pose)
    arm = pose.arm
    if arm.n <= arm.k:
        raise InputError(f"null space: {arm.n} arm joints and {arm.k} task rows leave no self-motion to damp.")
    if kind not in (None, *KINDS):
        raise InputError(f'null space: the kind "{kind}" is unknown. Give one of {", ".join(KINDS)}.')
    omega = positive_number("null-space frequency", frequency, "rad/s")
    zeta = positive_number("null-space damping ratio", damping_ratio, "1")
    E = loop_on(pose.arm, loop).gain
    consistent = kind == "consistent" or (kind is None and shares_one_beta(pose, E))
    W = (_consistent if consistent else _blind_to_base)(pose, E)
    eye = np.eye(len(W))
    return NullSpaceDamping(pose, W, omega**2 * eye, 2.0 * zeta * omega * eye)


def self_motion_damping(pose: Pose, loop: Asked = None, *, frequency: float) -> tuple[NullSpaceDamping, str]:
    """`null_space_damping` as by default; where that does not exist the consistent kind, and why ("" elsewhere)."""
    try:
        return null_space_damping(pose, loop, frequency=frequency), ""
    except Infeasible as fault:
        return null_space_damping(pose, loop, frequency=frequency, kind="consistent"), str(fault)


def shares_one_beta(pose: Pose, E: Array) -> bool:
    """Whether V = beta Jp with one beta outside [0, 1], so that the consistent kind is safe.  [theory §7]"""
    Jp = pose.Jp
    V = pose.Jv @ np.linalg.solve(pose.Mhat - E, pose.Map)
    size = float(np.sum(Jp * Jp))
    if size == 0.0:
        return False
    beta = float(np.sum(V * Jp)) / size
    return not 0.0 <= beta <= 1.0 and float(np.linalg.norm(V - beta * Jp)) <= ONE_BETA * float(np.sqrt(size))


def self_motions(pose: Pose, E: Array) -> Array:
    """Basis N of the arm motions that leave the tip still, Jv N = 0, with N^T (Mhat - E) N = I, shape (n, n - k)."""
    basis = np.linalg.svd(pose.Jv)[2][pose.arm.k :].T
    inertia = basis.T @ (pose.Mhat - E) @ basis
    return np.asarray(np.linalg.solve(np.linalg.cholesky(inertia), basis.T).T)


def _consistent(pose: Pose, E: Array) -> Array:
    """W = N^T X: W Y Jv^T = (Jv N)^T = 0 and W N = I."""
    return np.asarray(self_motions(pose, E).T @ (pose.Mhat - E))


def _blind_to_base(pose: Pose, E: Array) -> Array:
    """W = N^T X (I - T V^+ Jv) with T = Y Map and V = Jv T: W T = 0 because V^+ V = I, and W N = I.

    T's columns are recombined to orthonormal ones in X, as many as Map has rank; V^+ is weighted by the tip's mobility.
    """
    k = pose.arm.k
    Jv, L = pose.Jv, np.linalg.cholesky(pose.Mhat - E)
    force = np.linalg.solve(L, Jv.T)
    into, sizes, _ = np.linalg.svd(np.linalg.solve(L, pose.Map), full_matrices=False)
    reach = int(np.sum(sizes > FELT * sizes.max(initial=0.0)))
    root = np.linalg.cholesky(force.T @ force)
    V = np.linalg.solve(root, force.T @ into[:, :reach])
    felt = int(np.sum(np.linalg.svd(V, compute_uv=False) > FELT))
    if felt < reach:
        raise Infeasible(
            f"null space: the arm moves {reach} motion{'s' * (reach != 1)} of the base, the {k} task "
            f"row{'s' * (k != 1)} feel {felt} of them, so no self-motion control leaves the base alone. Give more task "
            "rows, or a gain that aligns all modes with one beta (convex, objective aligned): kind consistent is safe "
            "then."
        )
    T = np.linalg.solve(L.T, into[:, :reach])
    W = _consistent(pose, E)
    return np.asarray(W - (W @ T) @ np.linalg.pinv(V) @ np.linalg.solve(root, Jv))
