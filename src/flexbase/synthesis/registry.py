"""The table of controllers for real hardware: one decorator line a method."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from flexbase.checks import choose
from flexbase.errors import InputError
from flexbase.model.sensing import TYPICAL, Sensing, checked_sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.sampled.controller import SampledController

Make = Callable[..., SampledController]  # (pose, sensing, gains, **options)


class HardwareMethod(NamedTuple):
    """A registered method: makes a controller for a pose, a sensing and task gains."""

    name: str
    purpose: str
    make: Make


HARDWARE_METHODS: dict[str, HardwareMethod] = {}


def hardware_method(name: str, purpose: str) -> Callable[[Make], Make]:
    """Register a maker under a name."""

    def register(make: Make) -> Make:
        HARDWARE_METHODS[name] = HardwareMethod(name, purpose, make)
        return make

    return register


def controller_for(
    pose: Pose, method: str, sensing: Sensing | None = None, gains: Gains | None = None, **options: Any
) -> SampledController:
    """A sampled controller at a pose by one of the methods.

    sensing : how the loop runs; if left out, as the project declares it, else 1 kHz with one sample of delay
    gains : the project's own if left out
    Raises InputError, Infeasible.
    """
    chosen = choose("method", method, HARDWARE_METHODS)
    used = pose.arm.gains if gains is None else gains
    if used is None:
        raise InputError(f"{pose.plant.name}: no task gains. Add a [control] table to the project, or give gains.")
    declared = (pose.arm.sensing or TYPICAL) if sensing is None else sensing
    return chosen.make(pose, checked_sensing(declared, pose.arm.n), used, **options)
