"""Convex design for any number of base joints, arm joints and task rows, always implementable.  [theory §7, §8]

In the arm's mobility Y = (Mhat - E)^-1 the input shape V = Jv Y Map and the inertia S = Mpp - Mpa Y Map are affine.
V = beta Jp with one beta outside (0, 1) makes the plant positive real at any damping of the base. (Y, beta) are jointly
affine, so beta <= 0 and beta >= 1 are two semidefinite programs; the bound on the algebraic loop is a box on Y. Where
one beta has no solution each mode may have its own.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np

from flexbase.checks import Array, positive_number
from flexbase.compensators.judge.certificate import certify
from flexbase.compensators.judge.gain_shortage import cautions_of_shortage, target_residual
from flexbase.compensators.judge.implementable import RADIUS, checked_radius
from flexbase.compensators.judge.lag_law import SHARE as SHARE_OF_DAMPING
from flexbase.compensators.judge.lag_law import LagLaw, check_obeyed, checked_law, obeys
from flexbase.compensators.judge.least_lacking import PARTS, check_no_worse, least_lacking
from flexbase.compensators.judge.refusals import aligned, aligned_each, check_frequencies, what_binds
from flexbase.compensators.options import Lag, LagShare, Radius
from flexbase.compensators.registry import method
from flexbase.compensators.search.descent import descend, shortage_and_slope
from flexbase.compensators.search.least_misalignment import MARGIN, least_misalignment
from flexbase.compensators.search.mobility_program import MobilityProgram
from flexbase.compensators.search.one_beta import one_beta
from flexbase.compensators.search.two_modes import TwoModes
from flexbase.control.compensator import Compensator
from flexbase.errors import Infeasible, InputError
from flexbase.model.loop import Asked
from flexbase.plant import Pose
from flexbase.requests import Says

OBJECTIVES = ("aligned", "mode-by-mode", "least-misaligned")
SOLVABLE = 1e-9  # relative residual of V = beta Jp up to which the equation counts as solvable


@method("convex", "any base, arm and task: semidefinite program, with a bound on the algebraic loop's radius")
def convex(
    pose: Pose,
    *,
    natural_frequency: Annotated[float | None, Says("lower bound of all modes", unit="rad/s", written="W")] = None,
    highest_frequency: Annotated[float | None, Says("upper bound of all modes", unit="rad/s", written="W")] = None,
    radius: Radius = RADIUS,
    margin: Annotated[float, Says("distance of beta from 0 and 1", written="B")] = MARGIN,
    objective: Annotated[str | None, Says("what is reached", choices=OBJECTIVES)] = None,
    lag: Lag = None,
    lag_share: LagShare = SHARE_OF_DAMPING,
    loop: Asked = None,
) -> Compensator:
    """Least change of the arm's mobility that makes the plant positive real, under rho(Ms^-1 E) <= radius.  [theory §7]

    Assumes a compliant base; leaves gravity stiffness out of the equations. Needs the extra "convex".

    natural_frequency, highest_frequency : bounds on all natural frequencies, from below (the slowest) and above
        [rad/s]; equal ones fix the frequency of a one-joint base
    radius : bound on the algebraic loop's radius, below 1
    margin : distance of beta from (0, 1); half the largest that exists where that is less
    objective : "aligned", V = beta Jp, which needs k + m <= n + 1 in general: positive real at any damping; or
        "mode-by-mode", on two base joints, each mode aligned with a beta of its own: positive real at the base's own
        damping; or "least-misaligned", as near to that as the bounds let it: positive real where the certificate says
        so, and never further from it than without E. Left out: the first of the three that is feasible
    lag : total lag of the measured acceleration [s] that may take at most `lag_share` of each mode's damping, by the
        delay law of theory §8. Exact for one base joint and mode by mode; else the shapes it speaks of are re-solved in
        passes, so that a refusal is no proof. Every answer obeys it with its own modes
    Raises Infeasible, naming what binds: the frequencies, and for the first two the lag (with the largest that would
    do), the radius (with the smallest that would do) or the equation itself.
    """
    if pose.arm.m == 0:
        raise InputError("convex: the base is rigid, so there is no mode to shape.")
    if objective == "mode-by-mode" and pose.arm.m != 2:
        raise InputError(
            f"objective: mode-by-mode is for two base joints, {pose.arm.m} given. Ask for another, or leave it out."
        )
    if not 0.0 <= margin < np.inf:
        raise InputError(f"margin: {margin!r} must be 0 or more. {MARGIN:g} is the usual choice.")
    law = checked_law(lag, lag_share)
    program = MobilityProgram(pose, checked_radius(radius), *_bounds(pose.arm.m, natural_frequency, highest_frequency))
    misfit = program.misfit()
    solvable, still = misfit <= SOLVABLE, misfit == np.inf
    if objective == "aligned" and not solvable and not still:
        raise Infeasible(
            f"V = beta Jp has no solution for {pose.arm.m} base joints, {pose.arm.n} arm joints and {pose.arm.k} task "
            f"rows (relative misfit {misfit:.2g}). Ask for the objective least-misaligned, or fewer rows."
        )
    check_frequencies(program)
    E = one_beta(program, law, margin) if solvable and objective != "least-misaligned" else None
    if E is not None:
        return certify(pose, "convex", E, target_residual=program.residual(E), loop=loop)
    if objective == "aligned" and not still:
        raise Infeasible(what_binds(program, law, aligned))
    each = _mode_by_mode(program, law, margin, objective)
    E = _least_misaligned(program, law, margin) if each is None else each
    check_obeyed(law, pose, E)
    missing, cautions = target_residual(pose, E), cautions_of_shortage(pose, E)
    return certify(pose, "convex", E, target_residual=missing, loop=loop, cautions=cautions)


def _bounds(m: int, lowest: float | None, highest: float | None) -> tuple[float | None, float | None]:
    low = None if lowest is None else positive_number("natural frequency", lowest, "rad/s")
    high = None if highest is None else positive_number("highest frequency", highest, "rad/s")
    if low is not None and high is not None and low > high:
        raise InputError(f"highest frequency: {high:g} rad/s is below the natural frequency, {low:g} rad/s.")
    if low is not None and low == high and m > 1:
        raise InputError(f"highest frequency: {m} modes cannot all be at {low:g} rad/s. Give a higher one.")
    return low, high


def _mode_by_mode(program: MobilityProgram, law: LagLaw | None, margin: float, objective: str | None) -> Array | None:
    """Each mode aligned with a beta of its own; None where that is not asked for, or neither asked for nor feasible."""
    if program.pose.arm.m != 2 or objective == "least-misaligned":
        return None
    E = TwoModes(program, law).gain(margin)
    if E is None and objective == "mode-by-mode":
        raise Infeasible(what_binds(program, law, aligned_each))
    return E


def _least_misaligned(program: MobilityProgram, law: LagLaw | None, margin: float) -> Array:
    """Each mode near a beta of its own; then, where the frequencies are free, downhill from there and from E = 0."""
    pose = program.pose
    none = np.zeros((pose.arm.n, pose.arm.n))
    if program.bounded:
        E = least_misalignment(program.under(law), margin)
        check_no_worse(pose, E)
        return E
    if shortage_and_slope(pose, none)[0] == 0.0:  # a base that does not move the tip, for one
        return none
    if law is not None:
        return _lagged(program.under(law), law, margin)
    starts = (least_misalignment(program, margin), none)
    return least_lacking(pose, [descend(pose, program.radius, start)[1] for start in starts])


def _lagged(program: MobilityProgram, law: LagLaw, margin: float) -> Array:
    """The same under a delay law, which the descents do not know: of them and their parts, the best that obeys it."""
    pose, none = program.pose, np.zeros_like(program.box.L)
    try:
        starts = [least_misalignment(program, margin), none]
    except Infeasible:  # no pass obeys the law
        starts = [none]
    ends = [*starts, *(descend(pose, program.radius, start)[1] for start in starts)]
    parts = [part * E for E in ends for part in (1.0, *PARTS)]
    return least_lacking(pose, [none, *(E for E in parts if obeys(law, pose, E))])
