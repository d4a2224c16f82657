"""The outcome of many runs: what they come to, not how they went."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.plant import Pose
from flexbase.sheets.numbers import listed
from flexbase.sheets.sheet import Sheet, facts, make_sheet
from flexbase.sheets.told import Told
from flexbase.simulation.settling import SETTLED

OK, DIVERGED, INDEFINITE = 0, 1, 2
STATUS = {OK: "ok", DIVERGED: "diverged", INDEFINITE: "M - E not positive definite"}


@dataclass(frozen=True, eq=False)
class Runs(Told):
    """Moves and settlings, one an entry of every array, without their histories.

    start : arm joints, shape (runs, n); varied : a parameter's name -> its values, shape (runs,)
    q, rates : at the end, shape (runs, N); tip_error : at the end, shape (runs, k)
    peak_error_m : largest tip error after switching, rotations counted in rad; NaN unless ok
    settling_time_s : after switching, until the tip stays below 0.1 mm; NaN where it does not
    status : 0 ok, 1 diverged (or too long a step), 2 M - E was not positive definite on the way; 2 goes before 1
    step : of the integrator in the move and in the settling phase [s]
    cautions : what should be known of the loop and the steps
    step_error : what the steps cost: the change of q at switch and end where they are halved, in a few of the runs
    """

    goal: Pose
    start: Array
    varied: dict[str, Array]
    q: Array
    rates: Array
    tip_error: Array
    peak_error_m: Array
    settling_time_s: Array
    status: NDArray[np.int8]
    switch: float
    end: float
    step: tuple[float, float]
    step_error: float
    cautions: tuple[str, ...] = ()

    document: ClassVar = (
        "start",
        "varied",
        "q",
        "tip_error",
        "peak_error_m",
        "settling_time_s",
        "status=outcomes",
        "switch_s=switch",
        "end_s=end",
        "step_s=step",
        "step_error",
    )

    def __len__(self) -> int:
        return len(self.status)

    @property
    def settled(self) -> NDArray[np.bool_]:
        """Which runs come to stay below 0.1 mm."""
        return np.isfinite(self.settling_time_s)

    @property
    def outcomes(self) -> list[str]:
        """The status of each run in words."""
        return [STATUS[code] for code in self.status.tolist()]

    def sheet(self) -> Sheet:
        """How many settle, how fast, and what became of the others."""
        settled, runs = int(self.settled.sum()), len(self)
        times, peaks = (1e3 * found[np.isfinite(found)] for found in (self.settling_time_s, self.peak_error_m))
        some: list[tuple[str, str]] = []
        if len(times):
            some += [("settling time", f"median {np.median(times):.1f} ms, longest {times.max():.1f} ms")]
        if len(peaks):
            some += [("largest error after the switch", f"median {np.median(peaks):.3f} mm, most {peaks.max():.3f} mm")]
        return make_sheet(
            self.goal.plant.name,
            f"{runs} runs to {listed(self.goal.tip, self.goal.arm.task.rows, self.goal.arm.task.units)}",
            facts(
                (f"settled below {1e3 * SETTLED:g} mm", f"{settled}, {100.0 * settled / max(runs, 1):.1f} %"),
                *some,
                *((word, str(int(np.sum(self.status == code)))) for code, word in STATUS.items() if code != OK),
                ("error of the steps", f"{self.step_error:.1e} rad or m of a joint"),
            ),
            cautions=self.cautions,
        )
