"""Why the convex design refuses: the frequencies, the lag or the radius, and at which bound.  [theory §7, §8]"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexbase.compensators.judge.lag_law import LagLaw, words
from flexbase.compensators.search.mobility_program import ROOM, SIDES, MobilityProgram
from flexbase.compensators.search.one_beta import one_beta
from flexbase.compensators.search.two_modes import TwoModes
from flexbase.errors import Infeasible
from flexbase.linear.modal import modes

LAG_RANGE, LAG_STEPS = float(np.log(1e3)), 9  # the largest lag that a refusal names, sought below the asked one
RADIUS_STEPS = 12  # bisections for the smallest radius that a refusal names

Aligns = Callable[[MobilityProgram, LagLaw | None], bool]


def what_binds(program: MobilityProgram, law: LagLaw | None, meets: Aligns) -> str:
    """Why an alignment fails inside the bounds. The frequencies by themselves were checked before."""
    g, pose = program.radius, program.pose
    if law is not None and meets(program, None):
        return _largest_lag(program, law, meets)

    def aligns(other: MobilityProgram) -> bool:
        return meets(other, None)

    if program.bounded and aligns(MobilityProgram(pose, g)):
        frequencies = ", ".join(f"{mode.frequency:.4g}" for mode in modes(pose).modes)
        return (
            f"the natural frequencies bind: at radius {g:g} the modes can be aligned, and the frequencies can be had, "
            f"but not both (without E they are {frequencies} rad/s). Ask for others, or for a larger radius."
        )
    mend = "Choose another pose, or ask for the objective least-misaligned."
    low, high = g, 1.0 - 1e-6
    if not aligns(MobilityProgram(pose, high)):
        return f"no gain with an algebraic-loop radius below 1 aligns the modes here. {mend}"
    for _ in range(RADIUS_STEPS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if aligns(MobilityProgram(pose, middle)) else (middle, high)
    return f"the radius binds: gains that align the modes here have {high:.4f} or more, {g:g} is asked. {mend}"


def _largest_lag(program: MobilityProgram, law: LagLaw, meets: Aligns) -> str:
    """Which lag would leave an alignment. With a smaller lag whatever obeyed the law still does."""
    low, high = np.log(law.lag) - LAG_RANGE, np.log(law.lag)
    said = f"the lag binds: {words(law)}; without it the modes can be aligned here"
    if not meets(program, law._replace(lag=float(np.exp(low)))):
        return (
            f"{said}, but not with a thousandth of it either. Choose another pose, or the objective least-misaligned."
        )
    for _ in range(LAG_STEPS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if meets(program, law._replace(lag=float(np.exp(middle)))) else (low, middle)
    return (
        f"{said}, and with a lag up to {1e3 * np.exp(low):.4g} ms. Ask for a smaller lag, a larger share, or the "
        "objective least-misaligned."
    )


def aligned(program: MobilityProgram, law: LagLaw | None) -> bool:
    """Whether one beta aligns all modes."""
    if law is None:
        return any(program.farthest(side) is not None for side in SIDES)
    return one_beta(program, law, 0.0) is not None


def aligned_each(program: MobilityProgram, law: LagLaw | None) -> bool:
    """Whether each of two modes can have a beta of its own."""
    return TwoModes(program, law).widening() < -ROOM


def check_frequencies(program: MobilityProgram) -> None:
    """The bounds on the frequencies, without any alignment. Raises Infeasible with what is reachable."""
    if not program.bounded or program.reaches_frequencies():
        return
    slowest, fastest = program.reachable_frequencies()
    raise Infeasible(
        f"the natural frequencies bind: with radius {program.radius:g} the slowest mode cannot rise above "
        f"{slowest:.4f} rad/s, nor the fastest fall below {fastest:.4f}. Ask for others, or for a larger radius."
    )
