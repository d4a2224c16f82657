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


def compare(
    name: str, fast: Callable[[], object], against: str, slow: Callable[[], object], rounds: int = 7, inner: int = 1
) -> Ratio:
    """Time both in turn; `fast` runs `inner` times a round so that the clock resolves it."""
    fast(), slow()
    ratios = []
    for _ in range(rounds):
        slow_time = _seconds(slow)
        fast_time = _seconds(lambda: [fast() for _ in range(inner)]) / inner
        ratios.append(slow_time / fast_time)
    return Ratio(name, float(np.median(ratios)), against, (min(ratios), max(ratios)))


def _seconds(work: Callable[[], object]) -> float:
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin
