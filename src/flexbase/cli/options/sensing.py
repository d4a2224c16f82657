"""How the loop runs, as a command line gives it in place of the project's [sensing]."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from cyclopts import Group, Parameter

from flexbase.cli.options.common import option
from flexbase.cli.options.values import Vector, number, numbers, whole
from flexbase.errors import InputError
from flexbase.model.files.sensing_table import samples_between
from flexbase.model.sensing import TYPICAL, Sensing, checked_sensing
from flexbase.plant import Plant

SENSING = Group("Sensing", sort_key=25)


@Parameter(name="*", group=SENSING)
@dataclass(frozen=True)
class SensingOptions:
    """Clock, delays and sensors in place of the project's."""

    rate: Annotated[float | None, option(number, "HZ", "of controller, encoders and torques [Hz]")] = None
    task_every: Annotated[int | None, option(whole, "N", "the tip is measured once in so many samples")] = None
    task_rate: Annotated[float | None, option(number, "HZ", "instead of --task-every [Hz]")] = None
    compute_delay: Annotated[int | None, option(whole, "N", "samples from a measurement to its torque")] = None
    task_delay: Annotated[int | None, option(whole, "N", "samples by which the measured tip is late")] = None
    encoder_counts: Annotated[float | None, option(number, "N", "a turn, or a metre of a sliding joint")] = None
    acceleration: Annotated[
        str | None, Parameter(metavar="NAME", help="accelerometer, encoders or kalman (of encoders)")
    ] = None
    accelerometer_lag: Annotated[float | None, option(number, "S", "first-order lag [s]")] = None
    acceleration_filter: Annotated[float | None, option(number, "HZ", "corner of encoders' or Kalman filter")] = None
    acceleration_noise: Annotated[float | None, option(number, "A", "standard deviation [rad/s^2 or m/s^2]")] = None
    task_noise: Annotated[float | None, option(number, "X", "standard deviation [m or rad]")] = None
    torque_limit: Annotated[Vector | None, option(numbers, "T,T", "one an arm joint [N m or N]")] = None
    torque_slew: Annotated[Vector | None, option(numbers, "T,T", "one an arm joint [N m/s or N/s]")] = None

    def sensing(self, plant: Plant) -> Sensing:
        """The project's declaration, or the typical one, with what the options say. Raises InputError."""
        own = plant.arm.sensing or TYPICAL
        given = {name: value for name, value in vars(self).items() if value is not None}
        if "task_rate" in given:
            if "task_every" in given:
                raise InputError("--task-rate: --task-every says the same. Give one of them.")
            given["task_every"] = samples_between(given.get("rate", own.rate), given.pop("task_rate"), "--task-rate")
        try:
            return checked_sensing(replace(own, **given), plant.arm.n, "--")
        except InputError as fault:  # options are written with hyphens
            name, colon, rest = str(fault).partition(":")
            raise InputError(name.replace("_", "-") + colon + rest) from fault

    def declared(self, plant: Plant) -> bool:
        """Whether project or command line say how the loop runs."""
        return plant.arm.sensing is not None or any(value is not None for value in vars(self).values())
