"""What a controller may know: everything a robot measures, and never the deflection of its base."""

from __future__ import annotations

from typing import NamedTuple

from flexbase.trace.algebra import Scalar, Vector


class Measured(NamedTuple):
    """One instant, or a batch of them (each entry then holds many).

    time : since the start [s]
    joints, rates : arm joints and their velocities, n each
    tip_error, tip_rate : task error against the goal, as a camera at the goal sees it, and its derivative, k each
    """

    time: Scalar
    joints: Vector
    rates: Vector
    tip_error: Vector
    tip_rate: Vector
