"""What becomes of a torque command: late, within limits, no faster than the drive can change."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array, check_length
from flexbase.model.sensing import Sensing


class Drives:
    """The drives of many runs, at rest with a torque before the first command, shape (runs, n)."""

    def __init__(self, sensing: Sensing, torque: Array) -> None:
        n = torque.shape[1]
        self._waiting = [torque] * sensing.compute_delay
        self._limit = _each(sensing.torque_limit, n, "torque_limit")
        slew = _each(sensing.torque_slew, n, "torque_slew")
        self._change = None if slew is None else slew * sensing.step
        self._before = self._within(torque)
        self.saturated = np.zeros(len(torque), dtype=int)

    @property
    def waiting(self) -> bool:
        """Whether the torque of this sample was decided at an earlier one."""
        return bool(self._waiting)

    @property
    def next(self) -> Array:
        """The torque that acts from this sample on, where it is known before the sensors are read."""
        return self._shaped(self._waiting[0]) if self._waiting else self._before

    def apply(self, command: Array) -> Array:
        """Take this sample's command; returns the torque that acts until the next, shape (runs, n)."""
        self._waiting.append(command)
        wanted = self._waiting.pop(0)
        given = self._shaped(wanted)
        self.saturated += (given != wanted).any(axis=1)
        self._before = given
        return given

    def _within(self, torque: Array) -> Array:
        return torque if self._limit is None else np.asarray(np.clip(torque, -self._limit, self._limit))

    def _shaped(self, torque: Array) -> Array:
        limited = self._within(torque)
        if self._change is None:
            return limited
        return np.asarray(np.clip(limited, self._before - self._change, self._before + self._change))


def _each(values: tuple[float, ...] | None, n: int, name: str) -> Array | None:
    return None if values is None else check_length(name, values, n, "one for each arm joint")
