"""Confidence intervals of what draws can tell: probabilities of cells, and shares of the workspace."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaincinv, stdtrit

from flexbase.checks import Array

CONFIDENCE = 0.95


class Estimate(NamedTuple):
    """A value and its confidence interval."""

    value: float
    lower: float
    upper: float


def probability_interval(held: NDArray[np.int64], draws: int) -> tuple[Array, Array]:
    """Clopper-Pearson bounds of a probability, of how many draws held: exact, so at least 95 % for every probability.

    Assumes independent draws. A probability of all or no draws has 0.025^(1/draws) as its one bound: 0.9963 of 1000.
    """
    tail = 0.5 * (1.0 - CONFIDENCE)
    counts, place = np.unique(held, return_inverse=True)
    known = counts.astype(float)
    lower = np.where(counts > 0, betaincinv(np.maximum(known, 1.0), draws - known + 1.0, tail), 0.0)
    upper = np.where(counts < draws, betaincinv(known + 1.0, np.maximum(draws - known, 1.0), 1.0 - tail), 1.0)
    return lower[place].reshape(held.shape), upper[place].reshape(held.shape)


def expected_share(shares: Array) -> Estimate:
    """Mean of the draws' shares, each one observation in [0, 1], and its interval.

    The t interval of the mean after two draws of share 0 and two of share 1 are added: for shares that are 0 or 1 the
    interval of Agresti and Coull, and never of no width where all draws happen to agree.
    """
    padded = np.concatenate([shares, [0.0, 0.0, 1.0, 1.0]])
    count = padded.size
    centre = float(padded.mean())
    half = float(stdtrit(count - 1, 0.5 * (1.0 + CONFIDENCE)) * padded.std(ddof=1) / np.sqrt(count))
    return Estimate(float(shares.mean()), max(0.0, centre - half), min(1.0, centre + half))
