"""A sampled controller for a pose, as a user asks for it: by a method, or task PD around a given compensator."""

from __future__ import annotations

from typing import Any

from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Pose, check_pose
from flexbase.sampled.controller import SampledController, pd_with_gain
from flexbase.synthesis.registry import controller_for


def make_controller(pose: Pose, method: str | None = None, loop: Asked = None, **options: Any) -> SampledController:
    """A sampled controller at a pose.

    method : one of `HARDWARE_METHODS`, with its options; or left out, for task PD with the compensator of `loop`, or
        without any
    loop : compensator, task gains and sensing; a compensator alone; the project's own gains and sensing if left out
    Raises InputError, also where a method and a compensator are both given; Infeasible, MissingExtra.
    """
    check_pose(pose)
    meant = loop_on(pose.arm, loop)
    if method is None and not options:
        return pd_with_gain(pose, meant.sensing, meant.gains, meant.E, meant.name)
    meant.check_bare()
    return controller_for(pose, method or "none", meant.sensing, meant.gains, **options)
