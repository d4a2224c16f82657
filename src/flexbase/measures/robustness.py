"""Robustness of an arm configuration: distance of each vibration mode from positive realness."""

from __future__ import annotations

from flexbase.linear import reduced
from flexbase.linear.reduced import RealMode
from flexbase.measures.registry import Configuration, measure
from flexbase.trace.algebra import Scalar, smaller


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


@measure(
    "worst_robustness",
    unit="m/(N s^2)",
    purpose="the smallest w_i of all modes",
    all_modes=True,
    zero_is="all modes on their robust arm configuration",
    no_search="has kinks where modes change places; robustness takes the worst mode as well",
    needs=lambda m, n, k: None if m else "a base joint",
)
def worst_robustness(configuration: Configuration) -> Scalar:
    """min over i of w_i.  [U03 eq 9]"""
    worst, *others = [robustness(mode) for mode in configuration.modes]
    for other in others:
        worst = smaller(worst, other)
    return worst
