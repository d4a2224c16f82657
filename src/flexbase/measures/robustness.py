"""Robustness of an arm configuration: distance of each vibration mode from positive realness."""

from __future__ import annotations

from flexbase.linear import reduced
from flexbase.linear.reduced import RealMode
from flexbase.measures.registry import measure
from flexbase.trace.algebra import Scalar


@measure(
    "robustness",
    unit="m/(N s^2)",
    purpose="w_i, how far each mode is from positive realness",
    per_mode=True,
    zero_is="the robust arm configuration",
    zero_line="turn",
)
def robustness(mode: RealMode) -> Scalar:
    """w = lambda_min(R + R^T); at most 0 for two and more task rows.  [U03 eq 9, theory §4]

    Assumes a real mode shape (proportional damping, or one base joint).
    """
    return reduced.robustness(mode.a, mode.b)
