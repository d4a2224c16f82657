"""Fig. 7: the mode shaping matrix by the paper's recursion, and by one exact solve beside it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from flexbase.cautions import collected
from flexbase.checks import Array
from flexbase.compensators import design
from flexbase.compensators.judge.certificate import certify
from flexbase.control.compensator import Compensator
from flexbase.plant import Pose
from flexbase.study.paper import printed
from flexbase.study.paper.example import TARGET_FREQUENCY

REPEATS = 5  # of the exact design, the fastest counts: one run of some milliseconds is noisy


@dataclass(frozen=True, eq=False)
class Shaping:
    """Three gains for one task, w_1 = 0 at omega_1 = 346.8 rad/s, each with its certificate.

    recursion : 800 iterations with estimated slopes, seed 0, and their history  [U03 eq 13-16]
    exact : the least-gain solution of theory §7
    printed : the matrix that the paper prints, judged as it stands
    recursion_seconds, exact_seconds : wall-clock time of each design with its certificate, same machine, same run
    """

    recursion: Compensator
    exact: Compensator
    printed: Compensator
    recursion_seconds: float
    exact_seconds: float

    @property
    def time_ratio(self) -> float:
        """How many exact designs fit into one recursion."""
        return self.recursion_seconds / self.exact_seconds

    @property
    def iterations(self) -> Array:
        """Iteration numbers of the history, from 0."""
        return np.arange(len(self.recursion.history["robustness"]), dtype=float)


def shaping(pose: Pose, seed: int = 0) -> Shaping:
    """Design at the paper's pose by both methods. The warnings about delays stay in the certificates."""
    with collected(quietly=True):
        recursion, recursion_seconds = _timed(
            lambda: design(pose, "recursive", natural_frequency=TARGET_FREQUENCY, seed=seed)
        )
        runs = [_timed(lambda: design(pose, "exact", natural_frequency=TARGET_FREQUENCY)) for _ in range(REPEATS)]
        as_printed = certify(pose, "printed", printed.GAIN)
    exact, exact_seconds = min(runs, key=lambda run: run[1])
    return Shaping(recursion, exact, as_printed, recursion_seconds, exact_seconds)


def _timed(run: Callable[[], Compensator]) -> tuple[Compensator, float]:
    begin = time.perf_counter()
    found = run()
    return found, time.perf_counter() - begin
