"""The stiffest controller that is accepted, along one gain."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from flexbase.errors import Infeasible
from flexbase.plant import Pose
from flexbase.sampled.controller import SampledController
from flexbase.sampled.judged import Judged

LOWEST = 1e-3  # of the task stiffness: a softer loop is no answer
HALVINGS = 6  # of the logarithmic interval between an accepted scale and a refused one
FIRST_STEP = 0.5

Attempt = Callable[[float], Judged | None]  # scale of the task stiffness -> a controller tried, if there is one


def stiffest(
    attempt: Attempt, margin: float, highest: float = 1.0, halvings: int = HALVINGS, softest: float = 0.0
) -> list[Judged]:
    """Controllers tried on the way to the largest accepted scale: down from the highest, then bisection.

    Steps down square the factor, so that the first accepted scale is bracketed; acceptance need not be monotonic, and
    then an accepted scale next to a refused one is found. What is softer at the tip than `softest` is not looked for.
    """
    tried: list[Judged] = []

    def accepted(scale: float) -> bool:
        one = attempt(scale)
        if one is not None:
            tried.append(one)
        return one is not None and not too_soft() and one.seems_accepted(margin)

    def too_soft() -> bool:
        return bool(tried) and 0.0 < tried[-1].stiffness <= softest

    low, high, step = highest, highest, FIRST_STEP
    while not accepted(low):
        high, low, step = low, low * step, step * step
        if low < LOWEST * highest or too_soft():
            return tried
    for _ in range(halvings if low < high else 0):
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if accepted(middle) else (low, middle)
    return tried


def best_of(tried: Sequence[Judged], margin: float, pose: Pose) -> SampledController:
    """The stiffest accepted one, or else the one nearest to acceptance, with what is known of it; notes say which.

    Raises Infeasible.
    """
    if not tried:
        raise Infeasible(f"{pose.plant.name}: no Riccati equation of the loop shaping has a solution at this pose.")
    hopeful = sorted((one for one in tried if one.seems_accepted(margin)), key=lambda one: -one.stiffness)
    best = next((one for one in hopeful if one.accepted(margin)), None) or max(tried, key=_nearness)
    best.controller.notes["accepted"] = best.accepted(margin)
    return replace(best.controller, judged=best)


def _nearness(one: Judged) -> float:
    return min(one.margins) - 10.0 * max(one.worst_radius - 1.0, one.radius - 1.0, 0.0)
