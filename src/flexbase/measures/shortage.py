"""Shortage: how much of a mode's own response is missing to positive realness, free of scale."""

from __future__ import annotations

from flexbase.linear import reduced
from flexbase.measures.registry import Configuration, measure
from flexbase.trace.algebra import Scalar, larger, norm, select

HIDDEN = 1e-10  # of the strongest mode's |a||b|: a weaker mode is one that the tip neither sees nor drives


@measure(
    "shortage",
    unit="1",
    purpose="(1 - cos(a, b))/2 of the worst mode: 0 is positive real, 1 its opposite",
    all_modes=True,
    small_is_good=True,
    no_search="has kinks where modes change places; alignment is one less twice the shortage of each mode",
    needs=lambda m, n, k: None if m else "a base joint",
)
def shortage(configuration: Configuration) -> Scalar:
    """Largest over i of -w_i / (2 |a_i||b_i|) = (1 - cos(a_i, b_i))/2, in [0, 1].  [U03 eq 9, theory §4]

    Assumes real mode shapes. Modes that the tip neither sees nor drives, to rounding, are left out: they harm nothing.
    """
    strengths = [norm(mode.a) * norm(mode.b) for mode in configuration.modes]
    strongest: Scalar = strengths[0]
    for strength in strengths[1:]:
        strongest = larger(strength, strongest)
    worst: Scalar = 0.0 * strongest
    for mode, strength in zip(configuration.modes, strengths, strict=True):
        missing = 0.5 * (1.0 - reduced.alignment(mode.a, mode.b))
        worst = larger(select(strength > HIDDEN * strongest, missing, 0.0), worst)
    return worst
