"""The outcome of a simulation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.plant import Pose
from flexbase.sheets import units
from flexbase.sheets.numbers import number
from flexbase.sheets.sheet import Column, Sheet, answer, facts, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.simulation.record import Record
from flexbase.simulation.settling import SETTLED


@dataclass(frozen=True, eq=False)
class Run(Record, Told):
    """A move and a settling phase.

    switch : when the task-space loop takes over [s]
    closed_loop_abscissa : rightmost pole of the linear loop at the goal [1/s]; positive, the run may only be too short
    engine : the physics behind it, "builtin" or "mujoco"
    """

    start: Pose
    compensated: bool
    closed_loop_abscissa: float
    engine: str = "builtin"

    document: ClassVar = (
        "t",
        "q",
        "tip_error",
        "torque",
        "switch_s=switch",
        "compensated",
        "engine",
        "settled",
        "settling_time_s",
        "peak_error_m",
        "peak_torque",
        "peak_speed",
        "closed_loop_abscissa",
        "caution",
        "stopped",
    )

    @property
    def settling(self) -> NDArray[np.bool_]:
        """Which samples belong to the settling phase, shape (T,)."""
        return np.array(self.t >= self.switch)

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

    def sheet(self) -> Sheet:
        """Peak torques and speeds, times and errors, and whether the tip settles."""
        arm, time, peak = self.goal.arm, self.settling_time_s, self.peak_error_m
        torque, speed = (units.each(quantity, arm.joint_units) for quantity in ("effort", "speed"))
        rows = [
            [name, f"{number(t, 6)} {t_unit}", f"{number(s, 6)} {s_unit}"]
            for name, t, t_unit, s, s_unit in zip(
                arm.joint_names, self.peak_torque, torque, self.peak_speed, speed, strict=True
            )
        ]
        unit = "mm (or mrad)" if "rad" in arm.task.units else "mm"
        settles = f"below {1e3 * SETTLED:g} mm"
        return make_sheet(
            self.goal.plant.name,
            f"simulated {'with' if self.compensated else 'without'} compensator, switch at {self.switch:g} s",
            table([words("joint"), Column("peak torque"), Column("peak speed")], rows),
            facts(
                ("settling time from the switch", "none" if time is None else f"{number(1e3 * time, 4)} ms"),
                ("largest tip error after the switch", "none" if peak is None else f"{number(1e3 * peak, 6)} {unit}"),
                ("samples", f"{len(self.t)}, to {number(float(self.t[-1]), 6)} s"),
                ("caution", self.caution) if self.caution else None,
            ),
            answer(self.settled, f"Settles {settles}", f"Does not settle {settles}", self.stopped or ""),
            cautions=self.cautions,
        )
