"""Alignment of the two directions in which the tip drives a mode and feels it."""

from __future__ import annotations

from flexbase.linear import reduced
from flexbase.linear.reduced import RealMode
from flexbase.measures.registry import measure
from flexbase.trace.algebra import Scalar


@measure("alignment", unit="1", purpose="cos(a, b) of each mode, 1 on the robust arm configuration", per_mode=True)
def alignment(mode: RealMode) -> Scalar:
    """cos(a, b) in [-1, 1], the scale-free companion of robustness.  [theory §4]

    Assumes a real mode shape; 1/2 where a or b vanishes, since the direction is then undefined and the mode harmless.
    """
    return reduced.alignment(mode.a, mode.b)
