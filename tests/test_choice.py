"""No design method that optimises passivity answers with a gain that is worse than none."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

import flexbase
from flexbase import FlexbaseWarning, Infeasible
from flexbase.compensators.judge.gain_shortage import relative_shortage
from flexbase.compensators.judge.implementable import BoundedGain
from flexbase.compensators.judge.least_lacking import least_lacking
from flexbase.compensators.search.descent import descend
from systems.passivity import loop_radius, passivity
from systems.random_plants import random_pose

pytest.importorskip("cvxpy")

# Descents end worse than no gain here, judged by the whole response: one in fourteen of 500 random plants.
WORSE = [
    (22, 3, 3, 2, "full"),
    (51, 2, 6, 6, "overdamped"),
    (69, 1, 4, 3, "proportional"),
    (140, 2, 5, 4, "zero"),
    (327, 2, 4, 3, "overdamped"),
]


def solve(pose, method, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlexbaseWarning)
        return flexbase.design(pose, method, **options)


@pytest.mark.parametrize("case", WORSE, ids=str)
@pytest.mark.parametrize("method", ["bounded", "convex"])
def test_no_answer_is_worse_than_no_gain(method, case):
    """The whole response lacks no more than without a gain, and the radius holds. 1e-9: the sweep's rounding."""
    seed, m, n, k, damping = case
    pose = random_pose(seed, m, n, k, damping=damping)
    found, none = solve(pose, method), np.zeros((n, n))
    assert relative_shortage(pose, found.E) <= relative_shortage(pose, none) + 1e-9
    assert loop_radius(pose, found.E) < 0.9


@pytest.mark.parametrize("seed", range(200, 230))
def test_random_plants_are_never_made_worse(seed):
    """Random sizes and dampings, the brute-force sweep of the full state space as the witness.

    It measures against the largest Hermitian eigenvalue instead of the largest |G|, so a gain may look up to a quarter
    worse by one and no worse by the other.
    """
    rng = np.random.default_rng(seed)
    m, n = int(rng.integers(1, 4)), int(rng.integers(1, 7))
    pose = random_pose(
        seed, m, n, int(rng.integers(1, n + 1)), damping=("proportional", "full", "overdamped")[seed % 3]
    )
    for method in ("bounded", "convex"):
        E = solve(pose, method).E
        assert passivity(pose, E) >= 1.25 * min(0.0, passivity(pose, np.zeros_like(E))) - 1e-6


def test_the_choice_falls_back_on_a_part_or_on_nothing():
    """A descent that ends worse is not taken: what is returned lacks less; of bad gains alone, nothing is better."""
    pose = random_pose(140, 2, 5, 4, damping="zero")
    none = np.zeros((5, 5))
    worse = descend(pose, 0.9, none)[1]
    assert relative_shortage(pose, worse) > relative_shortage(pose, none)  # the control
    chosen = least_lacking(pose, [worse])
    assert relative_shortage(pose, chosen) <= relative_shortage(pose, none)
    rng = np.random.default_rng(0)
    bad = max(
        (BoundedGain(pose, 0.9).at(root + root.T)[0] for root in rng.normal(size=(20, 5, 5))),
        key=lambda E: relative_shortage(pose, E),
    )
    assert relative_shortage(pose, least_lacking(pose, [bad])) <= relative_shortage(pose, none)
    assert np.array_equal(least_lacking(pose, [bad, none]), none)


@pytest.mark.slow
def test_frequencies_that_cost_passivity_are_refused():
    """With the frequencies bound no part of a gain will do: refused, with both shortages, where it would be worse."""
    refused = 0
    for seed in range(40):
        pose = random_pose(seed, 2, 3, 3)
        lowest = 1.15 * flexbase.modes(pose)[0].frequency
        try:
            E = solve(pose, "convex", natural_frequency=lowest).E
        except Infeasible as refusal:
            quoted = re.search(r"lacks ([0-9.e+-]+) % .* than no gain, ([0-9.e+-]+) %", str(refusal))
            if quoted is not None:
                refused += 1
                assert float(quoted.group(1)) >= float(quoted.group(2))
            if refused == 2:
                break
            continue
        assert relative_shortage(pose, E) <= relative_shortage(pose, np.zeros_like(E)) + 1e-9
    assert refused >= 1
