"""Exact design for one base joint: mode shaping is a linear equation.  [theory §7]"""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np

from flexbase.checks import Array, positive_number
from flexbase.compensators.judge.certificate import certify
from flexbase.compensators.judge.lag_law import SHARE, LagLaw, check_obeyed, checked_law, fastest, words
from flexbase.compensators.options import Lag, LagShare, Wanted
from flexbase.compensators.registry import method
from flexbase.compensators.search.exact_redundant import freest, lagged_bands, within
from flexbase.control.compensator import Compensator
from flexbase.errors import Infeasible, InputError
from flexbase.linear.aligned_gain import least_gain
from flexbase.linear.modal import modes
from flexbase.measures.compensability import coupling
from flexbase.measures.exact_design import CLEARANCE, RAISE
from flexbase.model.loop import Asked
from flexbase.plant import Pose
from flexbase.requests import Says

OBJECTIVES = ("least-gain", "least-radius")
STILL = 1e-12  # of the Jacobian, up to which the base does not move the tip
BELOW = 1.0 - 1e-6  # of the fastest frequency that the delay law allows: the default stays under it


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
    z, y, product = coupling(pose.M.tolist(), pose.J.tolist(), pose.arm.parts)
    remaining = float(pose.Mpp[0, 0]) + min(product, 0.0)
    solvable = product != 0.0 and remaining > 0.0
    slowest = float(np.sqrt(pose.arm.base.stiffness[0, 0] / remaining)) if solvable else float("inf")
    return Compensability(np.array(z), np.array(y), product, slowest)


@method("exact", "one base joint: both targets by one small solve; least gain or least algebraic-loop radius")
def exact(
    pose: Pose,
    *,
    natural_frequency: Wanted = None,
    objective: Annotated[str, Says("what is least", choices=OBJECTIVES)] = "least-gain",
    lag: Lag = None,
    lag_share: LagShare = SHARE,
    loop: Asked = None,
) -> Compensator:
    """Gain that aligns the one base mode, w = 0, at a chosen natural frequency.  [theory §7]

    Assumes one base joint; leaves gravity stiffness out of the equations. For a redundant arm (n > k) the motion z that
    undoes the base's is free by a self-motion, and is chosen for the smallest radius; the objective decides the rest.

    natural_frequency : wanted omega_1 [rad/s]; if left out, a quarter above the present one, or just above the lowest
        reachable one where that is higher; never above what `lag` allows
    objective : "least-gain" (smallest ||E||_F) or "least-radius" (smallest algebraic-loop radius, theory §8)
    lag : total lag of the measured acceleration [s] that may take at most `lag_share` of the mode's damping, by the
        delay law of theory §8; it bounds the reachable frequencies from above. Left out: no such constraint
    Raises Infeasible if no gain exists, or none at this frequency: the message says which, and what does exist.
    """
    law = checked_law(lag, lag_share)
    facts, frequency = (_redundant if pose.arm.n > pose.arm.k else _square)(pose, natural_frequency, law)
    alpha = _alpha(pose, facts, frequency)
    if objective == "least-gain":
        E: Array = np.array(least_gain(pose.Mhat.tolist(), facts.z.tolist(), facts.y.tolist(), alpha))
    else:
        E = _least_radius(pose, facts, alpha)
    check_obeyed(law, pose, E)
    residual = (pose.Mhat - E) @ facts.z - facts.y / alpha
    relative = float(np.linalg.norm(residual) / np.linalg.norm(facts.y / alpha))
    return certify(pose, "exact", E, target_residual=relative, loop=loop)


def reachable(pose: Pose, lag: float | None = None, lag_share: float = SHARE) -> tuple[float, float]:
    """Bounds of the frequencies with w = 0 [rad/s], the lower one excluded. Assumes m = 1, k = n.  [theory §7, §8]

    Infinite where there is no bound. Raises Infeasible where no gain aligns the mode, or none that the lag allows.
    """
    facts, law = _compensable(pose), checked_law(lag, lag_share)
    highest = _fastest(pose, facts, law)
    if law is not None and highest <= facts.slowest:
        raise Infeasible(
            f"the lag binds: {words(law)}, and no aligning gain obeys that here: with w = 0 only frequencies above "
            f"{facts.slowest:.4f} rad/s exist, and the lag allows none above {highest:.4f}. Ask for a smaller lag, a "
            "larger share, or another pose."
        )
    return facts.slowest, highest


def _compensable(pose: Pose) -> Compensability:
    facts = compensability(pose)
    if not np.isfinite(facts.slowest):
        raise Infeasible(
            f"no gain aligns the mode here: y.z = {facts.product:.4g} kg m^2 lies neither above 0 nor between "
            f"-{pose.Mpp[0, 0]:.4g} and 0. Choose another pose: a map of the measure compensability shows where."
        )
    return facts


def _fastest(pose: Pose, facts: Compensability, law: LagLaw | None) -> float:
    """Y y = alpha z whatever the objective, so the law is one of alpha alone.  [theory §8]"""
    if law is None:
        return float("inf")
    return fastest(law, pose, float(facts.z @ pose.Mhat @ facts.z) / facts.product**2)


def _square(pose: Pose, natural_frequency: float | None, law: LagLaw | None) -> tuple[Compensability, float]:
    """z, y and the frequency where there are as many task rows as arm joints. Raises Infeasible."""
    facts = _compensable(pose)
    highest = float("inf") if law is None else reachable(pose, *law)[1]
    if natural_frequency is None:
        usual = _default_frequency(pose, facts)
        return facts, usual if usual <= highest else max(BELOW * highest, 0.5 * (facts.slowest + highest))
    frequency = positive_number("natural frequency", natural_frequency, "rad/s")
    _check_lag_allows(frequency, facts.slowest, highest, law)
    return facts, frequency


def _check_lag_allows(frequency: float, slowest: float, highest: float, law: LagLaw | None) -> None:
    if law is not None and not slowest < frequency <= highest:
        raise Infeasible(
            f"natural frequency {frequency:g} rad/s is out of reach: {words(law)}, so with w = 0 only frequencies "
            f"above {slowest:.4f} and up to {highest:.4f} rad/s exist here. Ask for one of them, or for a smaller lag."
        )


def _redundant(pose: Pose, natural_frequency: float | None, law: LagLaw | None) -> tuple[Compensability, float]:
    """The same with more arm joints than task rows: V = beta Jp reads X t = y, Jv t = alpha Jp, with beta = -alpha."""
    _check_base(pose)
    if not np.abs(pose.Jp[:, 0]).max() > STILL * np.abs(pose.J).max():
        raise Infeasible("exact: the base does not move the tip here, so there is nothing to align. No gain is needed.")
    slowest = float(np.sqrt(pose.arm.base.stiffness[0, 0] / pose.Mpp[0, 0]))
    if natural_frequency is None:
        usual = RAISE * modes(pose)[0].frequency
        frequency = usual if law is None else within(lagged_bands(pose, law), usual)
    else:
        frequency = positive_number("natural frequency", natural_frequency, "rad/s")
    _check_reachable(pose, frequency, slowest)
    t, alpha = freest(pose, frequency, law)
    return Compensability(t / alpha, -pose.Map[:, 0], float(-pose.Map[:, 0] @ t) / alpha, slowest), frequency


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
    return float((pose.Mpp[0, 0] - pose.arm.base.stiffness[0, 0] / frequency**2) / facts.product)


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
    L = np.linalg.cholesky(pose.Ms)
    start, goal = L.T @ facts.z, np.linalg.solve(L, pose.Mhat @ facts.z - facts.y / alpha)
    radius = float(np.linalg.norm(goal) / np.linalg.norm(start))
    F = radius * _symmetric_turn(start / np.linalg.norm(start), goal)
    E = L @ F @ L.T
    if np.linalg.eigvalsh(pose.Mhat - E)[0] <= 0.0:
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
