"""Exact design for one base joint: mode shaping is a linear equation.  [theory §7]"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexbase.checks import Array, positive_number
from flexbase.control.compensator import Compensator
from flexbase.design.certificate import certify
from flexbase.design.registry import method
from flexbase.errors import Infeasible, InputError
from flexbase.linear.margins import arm_on_free_base
from flexbase.linear.modal import modes
from flexbase.measures.compensability import coupling
from flexbase.model.task import Gains
from flexbase.plant import Pose

OBJECTIVES = ("least-gain", "least-radius")
SMALLEST_INERTIA = 1e-3  # of the arm's own, kept in the directions that the targets leave free
RAISE = 1.25  # default target over the present frequency; the paper's example raises it by 1.2515
CLEARANCE = 1.02  # default target over the lowest reachable frequency


class Compensability(NamedTuple):
    """What decides whether one mode can be aligned.  [theory §7]

    z : Jv^-1 Jp, the arm motion that undoes the base's, shape (n,)
    y : -Map, how the arm pushes the base, shape (n,)
    product : y.z; compensable if positive, or between -Mpp and 0
    slowest : frequencies above this are reachable [rad/s]; infinite if not compensable
    """

    z: Array
    y: Array
    product: float
    slowest: float


def compensability(pose: Pose) -> Compensability:
    """The compensability test at a pose. Raises InputError unless m = 1 and k = n."""
    _check_scope(pose)
    z, y, product = coupling(pose.M.tolist(), pose.J.tolist())
    remaining = float(pose.M[0, 0]) + min(product, 0.0)
    solvable = product != 0.0 and remaining > 0.0
    slowest = float(np.sqrt(pose.arm.base.stiffness[0, 0] / remaining)) if solvable else float("inf")
    return Compensability(np.array(z), np.array(y), product, slowest)


@method("exact", "one base joint, k = n: both targets by one small solve; least gain or least algebraic-loop radius")
def exact(
    pose: Pose,
    *,
    natural_frequency: float | None = None,
    objective: str = "least-gain",
    gains: Gains | None = None,
) -> Compensator:
    """Gain that aligns the one base mode, w = 0, at a chosen natural frequency.  [theory §7]

    Assumes one base joint, as many task rows as arm joints; leaves gravity stiffness out of the equations.

    natural_frequency : wanted omega_1 [rad/s]; if left out, a quarter above the present one, or just above the lowest
        reachable one where that is higher
    objective : "least-gain" (smallest ||E||_F) or "least-radius" (smallest algebraic-loop radius, theory §8)
    Raises Infeasible if no gain exists, or none at this frequency: the message says which, and what does exist.
    """
    if objective not in OBJECTIVES:
        raise InputError(f'objective: "{objective}" is unknown. Give one of {", ".join(OBJECTIVES)}.')
    facts = compensability(pose)
    if not np.isfinite(facts.slowest):
        raise Infeasible(
            f"no gain aligns the mode here: y.z = {facts.product:.4g} kg m^2 lies neither above 0 nor between "
            f"-{pose.M[0, 0]:.4g} and 0. Choose another pose: a map of the measure compensability shows where."
        )
    if natural_frequency is None:
        frequency = _default_frequency(pose, facts)
    else:
        frequency = positive_number("natural frequency", natural_frequency, "rad/s")
    alpha = _alpha(pose, facts, frequency)
    E = (_least_gain if objective == "least-gain" else _least_radius)(pose, facts, alpha)
    residual = (pose.M[1:, 1:] - E) @ facts.z - facts.y / alpha
    relative = float(np.linalg.norm(residual) / np.linalg.norm(facts.y / alpha))
    return certify(pose, "exact", E, target_residual=relative, gains=gains)


def _check_scope(pose: Pose) -> None:
    arm = pose.arm
    if arm.m == 0:
        raise InputError("exact: the base is rigid, so there is no mode to shape.")
    if arm.m > 1:
        raise InputError(f"exact: {arm.m} base joints, but this method shapes one; task-priority shapes several.")
    if arm.k != arm.n:
        raise InputError(f"exact: {arm.k} task rows for {arm.n} arm joints; as many rows as joints are needed.")


def _default_frequency(pose: Pose, facts: Compensability) -> float:
    return max(RAISE * modes(pose)[0].frequency, CLEARANCE * facts.slowest)


def _alpha(pose: Pose, facts: Compensability, frequency: float) -> float:
    """alpha = (Mpp - Kp/omega^2) / (y.z): X z = y/alpha then meets both targets.  [theory §7]"""
    if frequency <= facts.slowest:
        raise Infeasible(
            f"natural frequency {frequency:g} rad/s is out of reach: with w = 0 only frequencies above "
            f"{facts.slowest:.4f} rad/s exist here (the mode is now at {modes(pose)[0].frequency:.4f}). "
            "Ask for a higher one."
        )
    return float((pose.M[0, 0] - pose.arm.base.stiffness[0, 0] / frequency**2) / facts.product)


def _least_gain(pose: Pose, facts: Compensability, alpha: float) -> Array:
    """Smallest ||E||_F with (Mhat - E) z = y/alpha and Mhat - E > 0.

    In the basis [z/|z|, Z] the target fixes all of E but the block Z^T E Z, and X > 0 exactly where
    T = Z^T X Z - Z^T y y^T Z / (alpha y.z) is positive: a projection on positive matrices, by eigenvalues.
    """
    Mhat, y, z = pose.M[1:, 1:], facts.y, facts.z
    missing = Mhat @ z - y / alpha
    square = float(z @ z)
    E = (np.outer(missing, z) + np.outer(z, missing)) / square - np.outer(z, z) * float(missing @ z) / square**2
    Z = _complement(z)
    wanted = Z.T @ (Mhat - np.outer(y, y) / (alpha * facts.product)) @ Z
    values, vectors = np.linalg.eigh(wanted)
    kept = np.maximum(values, SMALLEST_INERTIA * np.linalg.eigvalsh(Mhat)[0])
    return np.asarray(E + Z @ (vectors * (values - kept)) @ vectors.T @ Z.T)


def _least_radius(pose: Pose, facts: Compensability, alpha: float) -> Array:
    """Smallest rho(Ms^-1 E) with (Mhat - E) z = y/alpha.

    With Ms = L L^T and F = L^-1 E L^-T, rho is the spectral norm of F, and F must carry L^T z into L^-1 missing: no
    symmetric F does that with a smaller norm than the ratio of their lengths, and the reflection that maps one
    direction onto the other, times that ratio, attains it.
    """
    L = np.linalg.cholesky(arm_on_free_base(pose))
    start, goal = L.T @ facts.z, np.linalg.solve(L, pose.M[1:, 1:] @ facts.z - facts.y / alpha)
    radius = float(np.linalg.norm(goal) / np.linalg.norm(start))
    F = radius * _symmetric_turn(start / np.linalg.norm(start), goal)
    E = L @ F @ L.T
    if np.linalg.eigvalsh(pose.M[1:, 1:] - E)[0] <= 0.0:
        raise Infeasible(
            f"the smallest algebraic-loop radius at this frequency is {radius:.3f}, where M - E is no longer positive. "
            "Ask for a lower frequency, or for the objective least-gain."
        )
    return np.asarray(E)


def _symmetric_turn(start: Array, goal: Array) -> Array:
    """Symmetric, of rank at most 2 and norm 1, carrying the unit vector `start` into the direction of `goal`."""
    length = np.linalg.norm(goal)
    if length == 0.0:
        return np.zeros((len(start), len(start)))
    end = goal / length
    cosine = float(start @ end)
    across = end - cosine * start
    sine = float(np.linalg.norm(across))
    if sine < 1e-14:
        return np.asarray(np.sign(cosine) * np.outer(start, start))
    across = across / sine
    basis = np.column_stack([start, across])
    return np.asarray(basis @ np.array([[cosine, sine], [sine, -cosine]]) @ basis.T)


def _complement(z: Array) -> Array:
    """Orthonormal basis of the directions orthogonal to z, shape (n, n - 1)."""
    return np.linalg.svd(z[None, :])[2][1:].T
