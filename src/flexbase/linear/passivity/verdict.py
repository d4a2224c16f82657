"""What an exact verdict says, as data, as a table and as plain numbers.  [theory §5]"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from flexbase.checks import Array
from flexbase.linear.passivity.level_search import Interval
from flexbase.linear.passivity.stable_part import Port
from flexbase.plant import Pose
from flexbase.sheets.numbers import number
from flexbase.sheets.sheet import Sheet, answer, facts, make_sheet
from flexbase.sheets.told import Told

POSITIVE_REAL = 1e-8  # of the largest response: the shortage up to which it counts as positive real  [theory §5]


@dataclass(frozen=True, eq=False)
class Verdict(Told):
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
    compensated : whether a compensator is at work; cautions : what should be known of it
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
    compensated: bool = False
    cautions: tuple[str, ...] = ()

    document: ClassVar = (
        "*_place",
        "*_answer",
        "negative_imaginary_relative_shortage=negative_imaginary_shortage",
        "half_at_rad_s=half_at",
        "input_index",
        "output_index",
        "largest_gain",
        "largest_gain_at_rad_s=largest_at",
        "skew_low",
        "skew_high",
        "rigid_mode",
        "undamped_rad_s=undamped",
        "bandwidth_rad_s=bandwidth",
        "caveats",
        "base_alone=base_alone._answer",
    )

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

    def sheet(self) -> Sheet:
        """How far from positive real, where, and whether that is enough."""
        index = "open" if self.output_index is None else number(self.output_index, 6)
        if self.output_index == -np.inf:
            index = "none: no feedback of the velocity makes it passive"
        scope = "" if self.bandwidth is None else f", up to {number(self.bandwidth, 6)} rad/s"
        return make_sheet(
            self.name,
            f"exact verdict {'with' if self.compensated else 'without'} compensator{scope}",
            None if self.pose is None else self.pose.where,
            facts(
                ("shortage", self.in_words()),
                ("worst at", f"{number(self.worst_at, 6)} rad/s") if self.half_at else None,
                ("half of it", self.half_in_words()) if self.half_at else None,
                ("fails", self.failing_in_words()) if self.fails_at else None,
                ("negative imaginary", "yes" if self.negative_imaginary else "no"),
                ("output-passivity index", index),
            ),
            answer(self.positive_real, "Positive real", "Not positive real", " ".join(self.caveats)),
            cautions=self.cautions,
        )

    def _place(self) -> dict[str, Any]:
        return {} if self.pose is None else {"q": self.pose.q, "tip": self.pose.tip}

    def _answer(self) -> dict[str, Any]:
        return {
            "positive_real": self.positive_real,
            "shortage": self.shortage,
            "relative_shortage": self.relative_shortage,
            "negative_imaginary": self.negative_imaginary,
            "worst_at_rad_s": self.worst_at,
            "fails_at_rad_s": self.fails_at,
        }


def _joined(intervals: list[list[str]]) -> str:
    return f"{', '.join(' to '.join(ends) for ends in intervals)} rad/s"
