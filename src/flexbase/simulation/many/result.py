"""The outcome of many runs: what they come to, not how they went."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.plant import Pose

OK, DIVERGED, INDEFINITE = 0, 1, 2
STATUS = {OK: "ok", DIVERGED: "diverged", INDEFINITE: "M - E not positive definite"}


@dataclass(frozen=True, eq=False)
class Runs:
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

    def __len__(self) -> int:
        return len(self.status)

    @property
    def settled(self) -> NDArray[np.bool_]:
        """Which runs come to stay below 0.1 mm."""
        return np.isfinite(self.settling_time_s)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, None for NaN, with units in the names."""
        return {
            "start": self.start.tolist(),
            "varied": {name: values.tolist() for name, values in self.varied.items()},
            "q": _plain(self.q),
            "tip_error": _plain(self.tip_error),
            "peak_error_m": _plain(self.peak_error_m),
            "settling_time_s": _plain(self.settling_time_s),
            "status": [STATUS[code] for code in self.status.tolist()],
            "switch_s": self.switch,
            "end_s": self.end,
            "step_s": list(self.step),
            "step_error": self.step_error,
        }

    def summary(self) -> str:
        """How many settle, how fast, and what became of the others."""
        lines = [f"{self.goal.plant.name}: {len(self)} runs to {np.round(self.goal.tip, 4).tolist()}"]
        settled = int(self.settled.sum())
        lines.append(f"  settled below 0.1 mm: {settled} ({100.0 * settled / max(len(self), 1):.1f} %)")
        if settled:
            times = 1e3 * self.settling_time_s[self.settled]
            lines.append(f"  settling time: median {np.median(times):.1f} ms, longest {times.max():.1f} ms")
        if np.isfinite(self.peak_error_m).any():
            peaks = 1e3 * self.peak_error_m[np.isfinite(self.peak_error_m)]
            lines.append(
                f"  largest error after switching: median {np.median(peaks):.3f} mm, most {peaks.max():.3f} mm"
            )
        lines += [f"  {word}: {np.sum(self.status == code)}" for code, word in STATUS.items() if code != OK]
        lines.append(f"  error of the steps: {self.step_error:.1e} rad or m of a joint")
        return "\n".join(lines)


def _plain(array: Array) -> Any:
    whole = array.astype(object)
    whole[~np.isfinite(array)] = None
    return whole.tolist()
