"""Compare two ways to the same answer in one run, alternating, and report the ratio of their times."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np


class Ratio(NamedTuple):
    """How many times faster `name` is than `against`: the median over the rounds, and the spread (low, high)."""

    name: str
    ratio: float
    against: str
    spread: tuple[float, float]


class Side(NamedTuple):
    """One way: what to call, how often in a round so that the clock resolves it, and how much work a call does."""

    call: Callable[[], object]
    times: int = 1
    work: float = 1.0

    def seconds(self) -> float:
        """Wall time of a unit of work."""
        begin = time.perf_counter()
        for _ in range(self.times):
            self.call()
        return (time.perf_counter() - begin) / (self.times * self.work)


def race(name: str, fast: Side, against: str, slow: Side, rounds: int = 9) -> Ratio:
    """Time both in turn, a round each; the ratio of every round's pair of times."""
    fast.call(), slow.call()
    return median(name, against, [slow.seconds() / fast.seconds() for _ in range(rounds)])


def median(name: str, against: str, ratios: list[float]) -> Ratio:
    """The median of the rounds, their least and their greatest."""
    return Ratio(name, float(np.median(ratios)), against, (min(ratios), max(ratios)))
