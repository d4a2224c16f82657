"""Exact design for one base joint: mode shaping is a linear equation.  [theory §7]"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.linalg

from flexbase.checks import Array, positive_number
from flexbase.control.compensator import Compensator
from flexbase.design.certificate import certify
from flexbase.design.registry import method
from flexbase.errors import Infeasible, InputError
from flexbase.linear.aligned_gain import least_gain
from flexbase.linear.margins import arm_on_free_base
from flexbase.linear.modal import modes
from flexbase.measures.compensability import coupling
from flexbase.measures.exact_design import CLEARANCE, RAISE
from flexbase.model.task import Gains
from flexbase.plant import Pose

OBJECTIVES = ("least-gain", "least-radius")
BORDER = 0.1  # redundant arms: distance of alpha from [-1, 0], where the mode would be lost to force or tip
ATTAINED = 1.0 - 1e-9  # square of the radius below which the best self-motion exists
UNDRIVEN = 1e-9  # cosine of y and t below which the self-motion does not drive the base


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
    _check_base(pose)
    if pose.arm.k != pose.arm.n:
        raise InputError(
            f"compensability: {pose.arm.k} task rows for {pose.arm.n} arm joints; as many rows as joints are needed."
        )
    z, y, product = coupling(pose.M.tolist(), pose.J.tolist())
    remaining = float(pose.M[0, 0]) + min(product, 0.0)
    solvable = product != 0.0 and remaining > 0.0
    slowest = float(np.sqrt(pose.arm.base.stiffness[0, 0] / remaining)) if solvable else float("inf")
    return Compensability(np.array(z), np.array(y), product, slowest)


@method("exact", "one base joint: both targets by one small solve; least gain or least algebraic-loop radius")
def exact(
    pose: Pose,
    *,
    natural_frequency: float | None = None,
    objective: str = "least-gain",
    gains: Gains | None = None,
) -> Compensator:
    """Gain that aligns the one base mode, w = 0, at a chosen natural frequency.  [theory §7]

    Assumes one base joint; leaves gravity stiffness out of the equations. For a redundant arm (n > k) the motion z that
    undoes the base's is free by a self-motion, and is chosen for the smallest radius; the objective decides the rest.

    natural_frequency : wanted omega_1 [rad/s]; if left out, a quarter above the present one, or just above the lowest
        reachable one where that is higher
    objective : "least-gain" (smallest ||E||_F) or "least-radius" (smallest algebraic-loop radius, theory §8)
    Raises Infeasible if no gain exists, or none at this frequency: the message says which, and what does exist.
    """
    if objective not in OBJECTIVES:
        raise InputError(f'objective: "{objective}" is unknown. Give one of {", ".join(OBJECTIVES)}.')
    facts, frequency = (_redundant if pose.arm.n > pose.arm.k else _square)(pose, natural_frequency)
    alpha = _alpha(pose, facts, frequency)
    if objective == "least-gain":
        E: Array = np.array(least_gain(pose.M[1:, 1:].tolist(), facts.z.tolist(), facts.y.tolist(), alpha))
    else:
        E = _least_radius(pose, facts, alpha)
    residual = (pose.M[1:, 1:] - E) @ facts.z - facts.y / alpha
    relative = float(np.linalg.norm(residual) / np.linalg.norm(facts.y / alpha))
    return certify(pose, "exact", E, target_residual=relative, gains=gains)


def _square(pose: Pose, natural_frequency: float | None) -> tuple[Compensability, float]:
    """z, y and the frequency where there are as many task rows as arm joints. Raises Infeasible."""
    facts = compensability(pose)
    if not np.isfinite(facts.slowest):
        raise Infeasible(
            f"no gain aligns the mode here: y.z = {facts.product:.4g} kg m^2 lies neither above 0 nor between "
            f"-{pose.M[0, 0]:.4g} and 0. Choose another pose: a map of the measure compensability shows where."
        )
    if natural_frequency is None:
        return facts, _default_frequency(pose, facts)
    return facts, positive_number("natural frequency", natural_frequency, "rad/s")


def _redundant(pose: Pose, natural_frequency: float | None) -> tuple[Compensability, float]:
    """The same with more arm joints than task rows: V = beta Jp reads X t = y, Jv t = alpha Jp, with beta = -alpha."""
    _check_base(pose)
    slowest = float(np.sqrt(pose.arm.base.stiffness[0, 0] / pose.M[0, 0]))
    if natural_frequency is None:
        frequency = RAISE * modes(pose)[0].frequency
    else:
        frequency = positive_number("natural frequency", natural_frequency, "rad/s")
    _check_reachable(pose, frequency, slowest)
    return _freest(pose, frequency, slowest), frequency


def _freest(pose: Pose, frequency: float, slowest: float) -> Compensability:
    """z and y for the self-motion of the smallest radius: one eigenproblem.  [theory §7, §8]

    With sigma = Mpp - Kp/omega^2 = y.t, the radius of the best E with X t = y is |L^-1 (Mhat - y y^T / sigma) t| over
    |L^T t|, Ms = L L^T: homogeneous in t, which ranges over the span of one z and the arm's self-motions. alpha has to
    lie outside [-1, 0]; where the best t's does not, t is best on one of the borders, kept BORDER away.
    """
    Mhat, y = pose.M[1:, 1:], -pose.M[1:, 0]
    inertia = float(pose.M[0, 0] - pose.arm.base.stiffness[0, 0] / frequency**2)
    span = np.column_stack([np.linalg.pinv(pose.J[:, 1:]) @ pose.J[:, 0], _null_space(pose.J[:, 1:])])
    driven, first = span.T @ y, np.eye(span.shape[1])[0]
    borders = [inertia * first - alpha * driven for alpha in (BORDER, -1.0 - BORDER)]
    for bases in ([span], [span @ _null_space(border[None, :]) for border in borders]):
        found = [
            one for basis in bases if (one := _least_turned(pose, basis, Mhat - np.outer(y, y) / inertia)) is not None
        ]
        for _, t in sorted(found, key=lambda pair: pair[0]):
            scaled = t * (inertia / float(y @ t))
            alpha = float(np.linalg.lstsq(span, scaled, rcond=None)[0][0])
            if not -1.0 <= alpha <= 0.0:
                return Compensability(scaled / alpha, y, inertia / alpha, slowest)
    raise Infeasible(
        "no gain aligns the mode here: the arm's self-motion does not drive the base. Choose another pose."
    )


def _least_turned(pose: Pose, basis: Array, turn: Array) -> tuple[float, Array] | None:
    """The t in a subspace with the smallest |L^-1 turn t| / |L^T t|, and that ratio; None where y.t = 0 there.

    turn t = Ms t wherever y.t = 0, so 1 is only a limit, of ever larger self-motions (a low frequency). Then the t that
    drives the base most for its inertia is taken.
    """
    Ms, y = arm_on_free_base(pose), -pose.M[1:, 0]
    image, weight = turn @ basis, basis.T @ Ms @ basis
    values, vectors = scipy.linalg.eigh(image.T @ np.linalg.solve(Ms, image), weight)
    t = basis @ vectors[:, 0] if values[0] < ATTAINED else basis @ np.linalg.solve(weight, basis.T @ y)
    if abs(float(y @ t)) <= UNDRIVEN * float(np.linalg.norm(y) * np.linalg.norm(t)):
        return None
    moved = turn @ t
    return float(np.sqrt(moved @ np.linalg.solve(Ms, moved) / (t @ Ms @ t))), t


def _null_space(A: Array) -> Array:
    """Orthonormal columns that A, of full row rank, maps to zero."""
    return np.asarray(np.linalg.svd(A)[2][len(A) :].T)


def _check_base(pose: Pose) -> None:
    arm = pose.arm
    if arm.m == 0:
        raise InputError("exact: the base is rigid, so there is no mode to shape.")
    if arm.m > 1:
        raise InputError(
            f"exact: {arm.m} base joints, but this method shapes one; convex and task-priority shape several."
        )


def _default_frequency(pose: Pose, facts: Compensability) -> float:
    return max(RAISE * modes(pose)[0].frequency, CLEARANCE * facts.slowest)


def _alpha(pose: Pose, facts: Compensability, frequency: float) -> float:
    """alpha = (Mpp - Kp/omega^2) / (y.z): X z = y/alpha then meets both targets.  [theory §7]"""
    _check_reachable(pose, frequency, facts.slowest)
    return float((pose.M[0, 0] - pose.arm.base.stiffness[0, 0] / frequency**2) / facts.product)


def _check_reachable(pose: Pose, frequency: float, slowest: float) -> None:
    if frequency <= slowest:
        raise Infeasible(
            f"natural frequency {frequency:g} rad/s is out of reach: with w = 0 only frequencies above "
            f"{slowest:.4f} rad/s exist here (the mode is now at {modes(pose)[0].frequency:.4f}). "
            "Ask for a higher one."
        )


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
