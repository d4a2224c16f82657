"""The outcome of a sampled run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from flexbase.sampled.controller import SampledController
from flexbase.sampled.judged import dies_out
from flexbase.sheets.numbers import number
from flexbase.sheets.sheet import Sheet, answer, facts, make_sheet
from flexbase.sheets.told import Told
from flexbase.simulation.hardware.push import Push
from flexbase.simulation.record import Record
from flexbase.simulation.settling import SETTLED

GROWS = 1.5  # of the error between two quarters of the time judged: more than noise and counts make of one another


@dataclass(frozen=True, eq=False)
class SampledRun(Record, Told):
    """A run of a sampled controller on a nonlinear plant, one entry a sample of the controller.

    torque : as the drives gave it until the next sample, shape (T, n)
    switch : when the sampled controller takes over from joint tracking [s]; 0: at once
    spectral_radius : of the linear loop at the goal, a sample; below 1 the verdict is that it settles
    saturated_samples : in which a drive could not give the torque that it was asked for
    tolerance : tip error below which it counts as settled [m, and rad for rotation rows]
    """

    controller: SampledController
    push: Push | None
    spectral_radius: float
    saturated_samples: int
    engine: str
    seed: int
    tolerance: float = SETTLED

    document: ClassVar = (
        "method=controller.name",
        "engine",
        "rate_hz=controller.sensing.rate",
        "spectral_radius",
        "predicted_stable=predicted",
        "settled",
        "diverged",
        "stopped",
        "settling_time_s",
        "last_error_m=last_error",
        "growth",
        "tolerance_m=tolerance",
        "peak_error_m",
        "peak_torque",
        "saturated_samples",
        "switch_s=switch",
        "push=_push",
        "seed",
        "t",
        "q",
        "tip_error",
        "torque",
    )

    @property
    def diverged(self) -> bool:
        """Whether a joint became faster than any robot's."""
        return self.stopped is not None

    @property
    def predicted(self) -> bool:
        """The linear verdict at the goal: stable."""
        return dies_out(self.spectral_radius)

    @property
    def judged_from(self) -> float:
        """From when on the loop is left alone [s]: after the switch, and after the push."""
        return max(self.switch, 0.0 if self.push is None else round(self.push.start + self.push.duration, 9))

    @property
    def growth(self) -> float | None:
        """Root mean square error of the last quarter of the time judged, over that of the quarter before it."""
        late = self.error_size[self.t >= self.judged_from]
        quarter = len(late) // 4
        if self.diverged or quarter == 0:
            return None
        last, before = (float(np.sqrt(np.mean(part**2))) for part in (late[-quarter:], late[-2 * quarter : -quarter]))
        return last / before if before > 0.0 else 1.0

    @property
    def last_error(self) -> float | None:
        """Largest tip error in the last quarter of the time judged."""
        late = self.error_size[self.t >= self.judged_from]
        return None if self.diverged or len(late) < 4 else float(late[-(len(late) // 4) :].max())

    @property
    def settled(self) -> bool:
        """Whether the tip stays within the tolerance in the last quarter of the time judged, its error not growing.

        Time is judged after the switch and the push. Growing: half as large again as in the quarter before. A loop that
        grows more slowly than that is only told by `spectral_radius`.
        """
        error, growth = self.last_error, self.growth
        return error is not None and growth is not None and error < self.tolerance and growth < GROWS

    @property
    def settling_time_s(self) -> float | None:
        """Time from `judged_from` after which the tip stays within the tolerance; None if it does not settle."""
        if not self.settled:
            return None
        outside = np.flatnonzero((self.t >= self.judged_from) & (self.error_size >= self.tolerance))
        return float(self.t[outside[-1] + 1] - self.judged_from) if outside.size else 0.0

    @property
    def peak_error_m(self) -> float:
        """Largest tip error after the switch, push included."""
        late = self.error_size[self.t >= self.switch]
        return float(late.max(initial=0.0))

    def sheet(self) -> Sheet:
        """What was run, the linear verdict, and whether the tip settles."""
        time, last, settles = self.settling_time_s, self.last_error, f"below {1e3 * self.tolerance:g} mm"
        word = "stable" if self.predicted else "unstable"
        torques = ", ".join(number(torque, 4) for torque in self.peak_torque)
        return make_sheet(
            self.goal.plant.name,
            f"{self.controller.name} at {self.controller.sensing.rate:g} Hz, plant {self.engine}",
            facts(
                ("linear verdict", f"{word}, spectral radius {self.spectral_radius:.5f} a sample"),
                (
                    f"settling time after {self.judged_from:g} s",
                    "none" if time is None else f"{number(1e3 * time, 4)} ms",
                ),
                ("last tip error", f"{number(1e3 * last, 4)} mm (or mrad)") if last is not None else None,
                ("largest tip error after the switch", f"{number(1e3 * self.peak_error_m, 4)} mm (or mrad)"),
                ("peak torque", f"{torques} N m (or N)"),
                ("samples saturated", f"{self.saturated_samples} of {len(self.t)}"),
            ),
            answer(self.settled, f"Settles {settles}", f"Does not settle {settles}", self.stopped or ""),
            cautions=self.cautions,
        )

    @property
    def _push(self) -> list[float] | None:
        return None if self.push is None else [*self.push.force, self.push.start, self.push.duration]
