"""What an exact verdict says, as data, as a table and as plain numbers.  [theory §5]"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from flexbase.checks import Array
from flexbase.linear.passivity.level_search import Interval
from flexbase.linear.passivity.port import Port
from flexbase.plant import Pose

POSITIVE_REAL = 1e-8  # of the largest response: the shortage up to which it counts as positive real  [theory §5]


@dataclass(frozen=True, eq=False)
class Verdict:
    """Positive realness of G(s) = s P(s), tip force to tip velocity, and negative imaginariness of P.  [theory §5]

    With F = G - R0/s - undamped modes, H = (F + F*)/2 over 0 <= omega, or up to `bandwidth`:

    positive_real : inf lambda_min(H) >= -1e-8 max |F|, and R = R^T >= 0 of the rigid motion and of undamped modes
    shortage : nu = min(inf lambda_min(H), 0) [m/(N s)]; -inf where nothing added at the tip would help: an undamped
        mode with a residue that is not positive, a pose that falls
    relative_shortage : nu over max |F|, between -1 and 0
    worst_at : frequency of nu [rad/s]; None if positive real
    fails_at : intervals in which lambda_min(H) < -1e-8 max |F| [rad/s]
    half_at : intervals in which it is below nu/2: where the shortage is
    largest_gain, largest_at : max |F|, and where
    input_index : inf lambda_min(H), not cut off at 0
    output_index : largest rho with (G + G*)/2 >= rho G*G; -inf where there is none, None where undamped modes leave
        it open
    negative_imaginary : i (P - P*) >= 0 for omega > 0; the same property as G positive real, so that the tolerance
        of G decides
    negative_imaginary_shortage : by how much not, over max |P - R0/s^2|; slow motions count more than for G
    skew_low, skew_high : relative skew parts of the compliance at rest and of the mobility at high frequency, both
        without the rigid motion: either one proves that G is not positive real. None where something has no spring
    rigid_mode : R0, shape (k, k)
    undamped : frequencies of vibrations without damping [rad/s]
    caveats : plain words
    base_alone : the verdict with the springs and dampers of the base alone, where gravity's stiffness or joint friction
        are counted; else None
    port : F without directions that have no response
    """

    pose: Pose | None
    positive_real: bool
    shortage: float
    relative_shortage: float
    worst_at: float | None
    fails_at: tuple[Interval, ...]
    half_at: tuple[Interval, ...]
    largest_gain: float
    largest_at: float
    input_index: float
    output_index: float | None
    negative_imaginary: bool
    negative_imaginary_shortage: float
    skew_low: float | None
    skew_high: float
    rigid_mode: Array
    undamped: tuple[float, ...]
    bandwidth: float | None
    caveats: tuple[str, ...]
    base_alone: Verdict | None
    port: Port = field(repr=False)

    @property
    def name(self) -> str:
        """The plant's name."""
        return "system" if self.pose is None else self.pose.plant.name

    def in_words(self) -> str:
        """The shortage as people read it."""
        if not np.isfinite(self.shortage):
            return "without bound"
        return f"{self.shortage + 0.0:.9g} m/(N s), {100.0 * self.relative_shortage + 0.0:.6g} % of the largest gain"

    def failing_in_words(self) -> str:
        """`fails_at` as people read it; without the ends where it is only too small for the tolerance."""
        from_rest = self.skew_low is not None and self.skew_low > POSITIVE_REAL
        without_end = self.bandwidth is None and self.skew_high > POSITIVE_REAL
        shown = [[f"{low:.5g}", f"{high:.5g}"] for low, high in self.fails_at]
        if not shown:
            return "nowhere"
        if from_rest and without_end and len(shown) == 1:
            return "at all frequencies"
        shown[0][0] = "0" if from_rest else shown[0][0]
        shown[-1][1] = "all above" if without_end else shown[-1][1]
        return _joined(shown)

    def half_in_words(self) -> str:
        """`half_at` as people read it."""
        return _joined([[f"{low:.5g}", f"{high:.5g}"] for low, high in self.half_at]) if self.half_at else "nowhere"

    def least_eigenvalue(self, omega: Array) -> Array:
        """lambda_min of H at frequencies [rad/s]."""
        return self.port.least_eigenvalue(np.asarray(omega, dtype=float))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, with units in the names."""
        place = {} if self.pose is None else {"q": self.pose.q.tolist(), "tip": self.pose.tip.tolist()}
        return {
            **place,
            **self._answer(),
            "negative_imaginary_relative_shortage": self.negative_imaginary_shortage,
            "half_at_rad_s": [list(interval) for interval in self.half_at],
            "input_index": self.input_index,
            "output_index": self.output_index,
            "largest_gain": self.largest_gain,
            "largest_gain_at_rad_s": self.largest_at,
            "skew_low": self.skew_low,
            "skew_high": self.skew_high,
            "rigid_mode": self.rigid_mode.tolist(),
            "undamped_rad_s": list(self.undamped),
            "bandwidth_rad_s": self.bandwidth,
            "caveats": list(self.caveats),
            "base_alone": None if self.base_alone is None else self.base_alone._answer(),
        }

    def _answer(self) -> dict[str, Any]:
        return {
            "positive_real": self.positive_real,
            "shortage": self.shortage,
            "relative_shortage": self.relative_shortage,
            "negative_imaginary": self.negative_imaginary,
            "worst_at_rad_s": self.worst_at,
            "fails_at_rad_s": [list(interval) for interval in self.fails_at],
        }

    def summary(self) -> str:
        """A few lines in plain text."""
        where = "" if self.pose is None else f" at tip {np.round(self.pose.tip, 6).tolist()}"
        scope = "" if self.bandwidth is None else f" up to {self.bandwidth:.6g} rad/s"
        lines = [
            f"{self.name}{where}: {'' if self.positive_real else 'not '}positive real{scope}",
            f"  shortage {self.in_words()}",
            *([] if self.worst_at is None else [f"  worst at {self.worst_at:.6g} rad/s"]),
            *([] if not self.fails_at else [f"  fails {self.failing_in_words()}"]),
            *([] if not self.half_at else [f"  half of it {self.half_in_words()}"]),
            f"  {'' if self.negative_imaginary else 'not '}negative imaginary",
            f"  output-passivity index {'open' if self.output_index is None else f'{self.output_index:.6g}'}",
        ]
        return "\n".join([*lines, *(f"  {caveat}" for caveat in self.caveats)])


def _joined(intervals: list[list[str]]) -> str:
    return f"{', '.join(' to '.join(ends) for ends in intervals)} rad/s"
