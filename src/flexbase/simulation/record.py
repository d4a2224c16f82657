"""What every simulated run holds: its samples, and what is read off them."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np

from flexbase.checks import Array
from flexbase.plant import Pose
from flexbase.simulation.settling import error_sizes


@dataclass(frozen=True, eq=False)
class Record:
    """A motion to a goal, sampled at equal intervals.

    t : shape (T,) [s]; q, rates : shape (T, N); tip_error : true, not as measured, against the goal, shape (T, k)
    torque : all that the arm's drives deliver, compensator included, shape (T, n)
    switch : when the loop takes over from joint tracking [s]
    stopped : why the run ended early, or None; cautions : what should be known of the loop
    """

    goal: Pose
    t: Array
    q: Array
    rates: Array
    tip_error: Array
    torque: Array
    switch: float
    _: KW_ONLY
    stopped: str | None = None
    cautions: tuple[str, ...] = ()

    @property
    def error_size(self) -> Array:
        """Length of the tip error: positions in m, or rotations in rad where larger, shape (T,)."""
        return error_sizes(self.tip_error, self.goal.arm.task)

    @property
    def peak_torque(self) -> Array:
        """Largest torque of each arm joint [N m or N], shape (n,)."""
        return np.asarray(np.abs(self.torque).max(axis=0))
