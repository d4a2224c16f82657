"""What a sampled loop asks of a plant: show the sensors their instant, and go on to the next with torques held."""

from __future__ import annotations

from typing import NamedTuple, Protocol

from flexbase.checks import Array


class Seen(NamedTuple):
    """One instant of many runs, as it truly is.

    q, rates : all joints, shape (runs, N); tip_error : (runs, k); acceleration : what ideal or lagging accelerometers
    on the arm joints show, (runs, n)
    """

    q: Array
    rates: Array
    tip_error: Array
    acceleration: Array


class Physics(Protocol):
    """Many runs of plants with the same joints, at the same instant."""

    def observe(self, torque: Array, tip_force: Array) -> Seen:
        """The present instant; torque (runs, n) and tip force (runs, k) act from now on."""

    def advance(self, torque: Array, tip_force: Array, alive: Array) -> None:
        """Go on by a sample with these held; runs that are not `alive` may stay where they are."""
