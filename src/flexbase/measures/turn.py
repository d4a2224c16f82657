"""Turn: the angle between the two directions in which the tip drives a mode and feels it, with its sign."""

from __future__ import annotations

from math import pi

from flexbase.linear.reduced import RealMode
from flexbase.measures.registry import measure
from flexbase.trace.algebra import Scalar, atan2, dot, mul, sub


@measure(
    "turn",
    unit="rad",
    purpose="angle from b to a of each mode, with its sign",
    per_mode=True,
    zero_is="the robust arm configuration",
    needs=lambda m, n, k: None if k == 2 else "two task rows",
    no_search="is an angle with a sign; alignment is its cosine",
    period=2.0 * pi,
)
def turn(mode: RealMode) -> Scalar:
    """Angle from the input shape b to the output shape a, in (-pi, pi].  [theory §4]

    Assumes two task rows. w = |a||b| (cos(turn) - 1) touches zero without a change of sign; this angle passes through
    zero there, so that its sign changes near 0 trace the robust arm configurations (those near pi are their opposite).
    """
    (ax, ay), (bx, by) = mode.a, mode.b
    return atan2(sub(mul(bx, ay), mul(by, ax)), dot(mode.a, mode.b))
