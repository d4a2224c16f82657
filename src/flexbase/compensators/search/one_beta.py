"""One beta for all modes, V = beta Jp: two semidefinite programs, under a delay law a few rounds.  [theory §7]"""

from __future__ import annotations

from flexbase.checks import Array
from flexbase.compensators.judge.lag_law import LagLaw, obeys
from flexbase.compensators.search.least_misalignment import PASSES
from flexbase.compensators.search.mobility_program import SIDES, MobilityProgram, Solution

SHARE = 0.5  # of the largest reachable distance, where the margin itself is not reachable


def one_beta(program: MobilityProgram, law: LagLaw | None, margin: float) -> Array | None:
    """E of one beta for all modes; under a delay law, its mode shapes are re-solved until they obey it."""
    E: Array | None = None
    for _ in range(PASSES):
        tried = program if law is None else program.under(law, E)
        solution = _aligned(tried, margin)
        if solution is None:
            return None
        E = tried.gain(solution)
        if obeys(law, program.pose, E):
            return E
    return None


def _aligned(program: MobilityProgram, margin: float) -> Solution | None:
    """The smaller change of the two sides; on each, the margin or half of what is reachable. None where neither is."""
    found = []
    for side in SIDES:
        farthest = program.farthest(side)
        if farthest is not None:
            found.append(program.least_change(side, min(margin, SHARE * farthest)))
    return min((one for one in found if one is not None), key=lambda one: one.value, default=None)
