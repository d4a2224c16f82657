"""The outcome of a simulation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.plant import Pose
from flexbase.simulation.settling import SETTLED, error_sizes


@dataclass(frozen=True, eq=False)
class Run:
    """A move and a settling phase, sampled at equal intervals.

    t : shape (T,) [s]; q, rates : shape (T, N); tip_error : against the goal, shape (T, k)
    torque : all that the arm's drives deliver, compensator included, shape (T, n)
    switch : when the task-space loop takes over [s]
    closed_loop_abscissa : rightmost pole of the linear loop at the goal [1/s]; positive, the run may only be too short
    stopped : why the run ended early, or None
    engine : the physics behind it, "builtin" or "mujoco"
    cautions : what should be known of the loop
    """

    start: Pose
    goal: Pose
    t: Array
    q: Array
    rates: Array
    tip_error: Array
    torque: Array
    switch: float
    compensated: bool
    closed_loop_abscissa: float
    stopped: str | None = None
    engine: str = "builtin"
    cautions: tuple[str, ...] = ()

    @property
    def settling(self) -> NDArray[np.bool_]:
        """Which samples belong to the settling phase, shape (T,)."""
        return np.array(self.t >= self.switch)

    @property
    def error_size(self) -> Array:
        """Length of the tip error: positions in m, or rotations in rad where larger, shape (T,)."""
        return error_sizes(self.tip_error, self.goal.arm.task)

    @property
    def settling_time_s(self) -> float | None:
        """Time from switching after which the tip stays below 0.1 mm until the end; None if it never does."""
        outside = np.flatnonzero(self.settling & (self.error_size >= SETTLED))
        if self.stopped or not self.settling.any() or (outside.size and outside[-1] == len(self.t) - 1):
            return None
        first = outside[-1] + 1 if outside.size else int(np.argmax(self.settling))
        return float(self.t[first] - self.switch)

    @property
    def settled(self) -> bool:
        """Whether the tip comes to stay below 0.1 mm."""
        return self.settling_time_s is not None

    @property
    def peak_error_m(self) -> float | None:
        """Largest tip error after switching; None if the run ended before."""
        return float(self.error_size[self.settling].max()) if self.settling.any() else None

    @property
    def peak_torque(self) -> Array:
        """Largest torque of each arm joint [N m or N], shape (n,)."""
        return np.asarray(np.abs(self.torque).max(axis=0))

    @property
    def peak_speed(self) -> Array:
        """Largest speed of each arm joint [rad/s or m/s], shape (n,)."""
        return np.asarray(np.abs(self.goal.arm.parts.arm(self.rates)).max(axis=0))

    @property
    def caution(self) -> str | None:
        """What a settled run may hide: a linear loop that is unstable at the goal and only grows slowly."""
        if not self.settled or self.closed_loop_abscissa < 0.0:
            return None
        return (
            f"the linear loop is unstable at the goal (rightmost pole {self.closed_loop_abscissa:+.3g} 1/s): "
            "a longer run would grow."
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, with units in the names."""
        return {
            "t": self.t.tolist(),
            "q": self.q.tolist(),
            "tip_error": self.tip_error.tolist(),
            "torque": self.torque.tolist(),
            "switch_s": self.switch,
            "compensated": self.compensated,
            "engine": self.engine,
            "settled": self.settled,
            "settling_time_s": self.settling_time_s,
            "peak_error_m": self.peak_error_m,
            "peak_torque": self.peak_torque.tolist(),
            "peak_speed": self.peak_speed.tolist(),
            "closed_loop_abscissa": self.closed_loop_abscissa,
            "caution": self.caution,
            "stopped": self.stopped,
        }

    def summary(self) -> str:
        """A few lines in plain text."""
        if self.settling_time_s is None:
            verdict = f"does not settle below {1e3 * SETTLED:g} mm" + (f": {self.stopped}" if self.stopped else "")
        else:
            verdict = f"settles below {1e3 * SETTLED:g} mm within {1e3 * self.settling_time_s:.1f} ms of switching"
        peak = "none" if self.peak_error_m is None else f"{1e3 * self.peak_error_m:.3f} mm"
        speeds, torques = np.round(self.peak_speed, 3).tolist(), np.round(self.peak_torque, 2).tolist()
        return (
            f"{self.goal.plant.name} {'with' if self.compensated else 'without'} compensator: {verdict}\n"
            + (f"  caution: {self.caution}\n" if self.caution else "")
            + f"  peak error after switching {peak}\n"
            f"  peak torque {torques}, peak speed {speeds}"
        )
