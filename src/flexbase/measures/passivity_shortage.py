"""Passivity shortage of an arm on a one-joint base: the exact verdict's number in closed form."""

from __future__ import annotations

from math import inf

from flexbase.linear import reduced
from flexbase.measures.registry import Configuration, measure
from flexbase.trace.algebra import Scalar, select, smaller


@measure(
    "passivity_shortage",
    unit="m/(N s)",
    purpose="nu, by how much the tip's mobility lacks passivity; one base joint",
    zero_is="the robust arm configuration",
    zero_line="turn",
    needs=lambda m, n, k: None if m == 1 else "one base joint",
)
def passivity_shortage(configuration: Configuration) -> Scalar:
    """nu = min(w_1, 0) / (4 zeta_1 omega_1) = min(w_1, 0) S / (2 Dp), exact at any damping.  [theory §4, §5]

    What `verdict` finds, `shortage`; -infinity without damping, where w_1 < 0. Relative to the largest response it is
    the measure `shortage`, with the other sign.
    """
    (mode,) = configuration.modes
    w = smaller(reduced.robustness(mode.a, mode.b), 0.0)
    rate = 4.0 * (mode.damping_ratio * mode.frequency)
    damped = rate > 0.0
    return select(damped, w / select(damped, rate, 1.0), select(w < 0.0, -inf, 0.0))
