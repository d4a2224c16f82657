"""Undamped mode shapes of the reduced form, on any number type: what maps are made of."""

from __future__ import annotations

from flexbase.linear.reduced import RealMode, Reduced, shaped_mode, single_mode
from flexbase.trace.algebra import Matrix, dot, matvec
from flexbase.trace.eigen import generalised_eigen


def real_modes(reduced: Reduced, stiffness: Matrix, damping: Matrix) -> tuple[RealMode, ...]:
    """Modes with real shapes, slowest first, of a base with stiffness Kp and damping Dp, both m x m.

    Exact for one base joint and for proportional damping; otherwise the modes of the undamped base, each with the
    damping that its own shape meets. Assumes S positive definite in every configuration.
    """
    if len(stiffness) == 0:
        return ()
    if len(stiffness) == 1:
        return (single_mode(reduced, stiffness[0][0], damping[0][0]),)
    values, shapes = generalised_eigen(stiffness, reduced.S)
    return tuple(
        shaped_mode(reduced, phi, value, dot(phi, matvec(damping, phi)))
        for value, phi in zip(values, shapes, strict=True)
    )
