"""How the loop really runs: rates, delays, sensors and limits, as a project declares them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from flexbase.checks import check_length
from flexbase.errors import InputError, nearest_name

ACCELERATIONS = ("accelerometer", "encoders", "kalman")
SLOWEST, FASTEST = 1e-3, 1e6  # Hz of any loop
LEAST_LAG = 1e-9  # s: a shorter one is none
LEAST_CORNER = 1e-6  # of a filter, of the rate: a lower one only hears its own rounding
MOST_DELAY, MOST_EVERY = 50, 200  # samples: each is a state of every channel that it delays


@dataclass(frozen=True)
class Sensing:
    """A sampled controller's clock and senses. Made by hand, check it with `checked_sensing`.

    rate : of the controller, its encoders and its torque commands [Hz]
    task_every : the task sensor delivers once in so many samples, and its value is held between
    compute_delay : samples from a measurement to the torque that answers it
    task_delay : samples by which the task sensor is late, beside that
    encoder_counts : a turn (or a metre, of a sliding joint); None: not quantised
    acceleration : "accelerometer" on the joints, "encoders" (second differences, filtered) or "kalman" (of encoders)
    accelerometer_lag : first-order time constant [s]
    acceleration_filter : corner of the filter on differenced encoders, and bandwidth of the Kalman filter [Hz]
    acceleration_noise, task_noise : standard deviations [rad/s^2 or m/s^2], [m or rad]
    torque_limit, torque_slew : of every arm joint [N m or N], [N m/s or N/s]; None: none
    """

    rate: float = 1000.0
    task_every: int = 1
    compute_delay: int = 1
    task_delay: int = 1
    encoder_counts: float | None = None
    acceleration: str = "accelerometer"
    accelerometer_lag: float = 5e-4
    acceleration_filter: float = 200.0
    acceleration_noise: float = 0.0
    task_noise: float = 0.0
    torque_limit: tuple[float, ...] | None = None
    torque_slew: tuple[float, ...] | None = None

    @property
    def step(self) -> float:
        """Sampling interval [s]."""
        return 1.0 / self.rate

    @property
    def mean_task_delay(self) -> int:
        """Samples by which the tip error is late, a slower sensor's hold counted as its mean, rounded up."""
        return self.task_delay + self.task_every // 2

    def summary(self) -> str:
        """Clock, delays and the source of the acceleration, in a line."""
        task = "" if self.task_every == 1 else f", task sensor {self.rate / self.task_every:g} Hz"
        delays = f"delays {self.compute_delay} (computation) and {self.task_delay} (task sensor) samples"
        return f"{self.rate:g} Hz{task}, {delays}, acceleration from {self.source}"

    @property
    def source(self) -> str:
        """Where the acceleration comes from, in words."""
        if self.acceleration == "accelerometer":
            return f"accelerometers, lag {1e3 * self.accelerometer_lag:g} ms"
        what = "differenced encoders" if self.acceleration == "encoders" else "a Kalman filter of the encoders"
        return f"{what}, {self.acceleration_filter:g} Hz"


TYPICAL = Sensing()  # 1 kHz, one sample of delay: what is assumed where a project declares nothing

_WHOLE = {"task_every": (1, MOST_EVERY), "compute_delay": (0, MOST_DELAY), "task_delay": (0, MOST_DELAY)}
_UNITS = {
    "accelerometer_lag": "s",
    "acceleration_noise": "rad/s^2 or m/s^2",
    "task_noise": "m or rad",
    "torque_limit": "N m or N",
    "torque_slew": "N m/s or N/s",
}


def checked_sensing(sensing: Sensing, n: int, where: str = "sensing, ") -> Sensing:
    """The same, with limits as tuples of n floats; `where` is put before the field's name. Raises InputError."""
    if not isinstance(sensing, Sensing):
        raise InputError(f"{where.rstrip(', ')}: {sensing!r} says nothing on the loop. Give a Sensing.")
    _check_range(where, "rate", sensing.rate, SLOWEST, FASTEST, "Hz")
    for name, (low, high) in _WHOLE.items():
        value = getattr(sensing, name)
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise InputError(f"{where}{name}: {value} is not a number of samples. Give a whole one, {low} to {high}.")
    if sensing.acceleration not in ACCELERATIONS:
        hint = nearest_name(sensing.acceleration, ACCELERATIONS)
        raise InputError(f'{where}acceleration: "{sensing.acceleration}" is unknown. {hint}')
    if sensing.encoder_counts is not None:
        _check_range(where, "encoder_counts", sensing.encoder_counts, 1e-3, 1e12, "counts a turn or a metre")
    for name in ("accelerometer_lag", "acceleration_noise", "task_noise"):
        _check_range(where, name, getattr(sensing, name), 0.0, 1e6, _UNITS[name], zero=True)
    _check_range(where, "acceleration_filter", sensing.acceleration_filter, 0.0, FASTEST, "Hz")
    if 0.0 < sensing.accelerometer_lag < LEAST_LAG:
        raise InputError(f"{where}accelerometer_lag: {sensing.accelerometer_lag:g} s is below {LEAST_LAG:g} s. Give 0.")
    if sensing.acceleration != "accelerometer" and sensing.acceleration_filter >= 0.5 * sensing.rate:
        raise InputError(
            f"{where}acceleration_filter: {sensing.acceleration_filter:g} Hz is not below half the rate, "
            f"{0.5 * sensing.rate:g} Hz. Give a lower corner or a higher rate."
        )
    if sensing.acceleration != "accelerometer" and sensing.acceleration_filter < LEAST_CORNER * sensing.rate:
        raise InputError(
            f"{where}acceleration_filter: {sensing.acceleration_filter:g} Hz is below {LEAST_CORNER * sensing.rate:g} "
            "Hz, a millionth of the rate. Give a higher corner."
        )
    return replace(
        sensing,
        rate=float(sensing.rate),
        torque_limit=_limits(where, "torque_limit", sensing.torque_limit, n),
        torque_slew=_limits(where, "torque_slew", sensing.torque_slew, n),
    )


def _check_range(where: str, name: str, value: Any, low: float, high: float, unit: str, zero: bool = False) -> None:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if not number or not (low <= value if zero else low < value) or not value <= high:
        asked = f"from {low:g}" if zero else f"above {low:g}"
        raise InputError(f"{where}{name}: {value} must be {asked} and at most {high:g} {unit}. Give such a number.")


def _limits(where: str, name: str, value: Sequence[float] | None, n: int) -> tuple[float, ...] | None:
    if value is None:
        return None
    given = check_length(f"{where}{name}", value, n, "one for each arm joint")
    if (given <= 0.0).any():
        raise InputError(f"{where}{name}: {given.min():g} {_UNITS[name]} must be above 0. Leave it out for no limit.")
    return tuple(given.tolist())
