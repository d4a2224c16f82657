"""How the loop really runs: rates, delays, sensors and limits, as a project declares them."""

from __future__ import annotations

from dataclasses import dataclass

ACCELERATIONS = ("accelerometer", "encoders", "kalman")


@dataclass(frozen=True)
class Sensing:
    """A sampled controller's clock and senses.

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


TYPICAL = Sensing()  # 1 kHz, one sample of delay: what is assumed where a project declares nothing
