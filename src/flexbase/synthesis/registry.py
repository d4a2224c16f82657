"""The table of controllers for real hardware: one decorator line a method."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any, NamedTuple

from flexbase.checks import check_options, choose
from flexbase.model.loop import Loop, loop_on
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose, check_pose
from flexbase.requests import Option, Says, options_of
from flexbase.sampled.controller import SampledController

Margin = Annotated[float, Says("disk margin that is asked for", written="A")]
Make = Callable[..., SampledController]  # (pose, sensing, gains, **options)


class HardwareMethod(NamedTuple):
    """A registered method: makes a controller for a pose, a sensing and task gains.

    as_given : options with which it keeps to the stiffness that is asked, where it would choose a softer one by itself
    law : what stays when its controller is used elsewhere: "controller", all of it; "gains", task PD, with its E
        where it has one, that follows the arm
    """

    name: str
    purpose: str
    make: Make
    as_given: Mapping[str, Any]
    law: str

    @property
    def options(self) -> tuple[Option, ...]:
        """What its signature says about its options."""
        return options_of(self.make)


HARDWARE_METHODS: dict[str, HardwareMethod] = {}


def hardware_method(
    name: str, purpose: str, *, as_given: Mapping[str, Any] | None = None, law: str = "controller"
) -> Callable[[Make], Make]:
    """Register a maker under a name; options that a person may give are annotated with `Says`."""

    def register(make: Make) -> Make:
        HARDWARE_METHODS[name] = HardwareMethod(name, purpose, make, as_given or {}, law)
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
    check_pose(pose)
    loop = loop_on(pose.arm, Loop(gains=gains, sensing=sensing))
    check_options(method, chosen.make, options)
    return chosen.make(pose, loop.sensing, loop.gains, **options)
