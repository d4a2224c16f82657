"""A force on the tool for a while."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexbase.checks import Array, check_length
from flexbase.errors import InputError
from flexbase.model.sensing import Sensing


@dataclass(frozen=True, eq=False)
class Push:
    """A force on the tool from `start` [s], rounded to samples, for `duration` [s].

    force : one for each task row [N or N m]
    """

    force: tuple[float, ...]
    start: float
    duration: float

    def forces(self, samples: int, sensing: Sensing, k: int) -> Array:
        """Tip force at every sample, shape (samples, k). Raises InputError for one that does not end within them."""
        force = check_length("push", self.force, k, "one for each task row")
        start, duration = check_length("push", [self.start, self.duration], 2, "its start and duration [s]").tolist()
        begin = round(start * sensing.rate)
        stop = begin + max(1, round(duration * sensing.rate))
        if not 0 <= begin < stop < samples or not duration > 0.0:
            raise InputError(
                f"push: from {start:g} s for {duration:g} s does not end within the run. Give other times."
            )
        forces = np.zeros((samples, k))
        forces[begin:stop] = force
        return forces
