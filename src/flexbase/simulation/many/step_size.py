"""How long the steps of many runs may be: halving them must move no joint by more than a tolerance."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexbase.cautions import caution
from flexbase.checks import Array
from flexbase.linear.closed_loop import close_loop
from flexbase.linear.linearise import linearise
from flexbase.model.loop import Gain, LoopSpec
from flexbase.plant import Pose

LONGEST = 2e-4  # s, a step
SHORT = 0.25  # rad or 1/e of the fastest pole, a step, to begin with
REFINEMENTS = 8
SURE = 16.0  # steps shorter by this must also see a run diverge, or the step is to blame


def first_step(goal: Pose, loop: LoopSpec) -> float:
    """A step to begin with, short against the fastest pole of the linear loop at the goal [s]."""
    poles = np.linalg.eigvals(np.asarray(close_loop(linearise(goal, Gain(loop.gain)), loop.gains).state_space().A))
    return min(LONGEST, SHORT / float(np.abs(poles).max()))


def short_enough(probe: Callable[[float], Array], longest: float, tolerance: float) -> tuple[float, float]:
    """The longest step that is short enough for a few runs, and what it costs them: the change by halving it.

    probe : of a step -> joints of the runs, NaN where they run away
    """
    coarse, error = probe(longest), np.inf
    for _ in range(REFINEMENTS):
        fine = probe(0.5 * longest)
        error = _difference(coarse, fine)
        if error <= tolerance and (not np.isnan(fine).any() or np.isfinite(_difference(fine, probe(longest / SURE)))):
            return longest, error
        longest, coarse = 0.5 * longest, fine
    caution(
        f"simulate_many: halving the step of {longest:.3g} s still moves a joint by {error:.2g}, more "
        f"than the tolerance of {tolerance:g}: the motion may be unstable. Give a larger tolerance or a shorter run."
    )
    return longest, error


def _difference(one: Array, other: Array) -> float:
    """The largest, of the runs that neither sees run away; infinite where only one does."""
    if np.any(np.isnan(one) != np.isnan(other)):
        return float(np.inf)
    gaps = np.abs(one - other)
    return float(np.max(gaps[~np.isnan(gaps)], initial=0.0))
