"""Is this the inertia of a body that could exist? Refused where it is impossible, noted where it is implausible."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.errors import InputError

INDEFINITE = 1e-4  # of the largest moment: what rounding to four digits can do to the smallest one
GROSS = 0.1  # of the largest moment C: what rounding each moment to two digits can do to A + B - C
ROUNDING = 1e-9


def tensor(xx: float, yy: float, zz: float, xy: float, xz: float, yz: float) -> Array:
    """The symmetric matrix of six moments."""
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def refuse_negative(where: str, mass: float, inertia: Array) -> None:
    """Raise InputError on a negative mass, or a principal moment that is negative by more than rounding.

    where : names the body in messages; inertia : about the centre of mass [kg m^2]
    """
    if mass < 0.0:
        raise InputError(f"{where}: its mass is negative. Give zero or a positive number of kg.")
    moments = np.linalg.eigvalsh(inertia)
    if moments[0] < -INDEFINITE * np.abs(moments).max():
        raise InputError(f"{where}: its inertia has a negative principal moment. Correct its moments of inertia.")


def judge_inertia(where: str, mass: float, inertia: Array) -> str | None:
    """A remark on an inertia that only rounding or a placeholder explains, or None. Raises InputError beyond that."""
    least, middle, most = np.linalg.eigvalsh(inertia).tolist()
    size = max(abs(least), abs(most))
    if size == 0.0:
        return "a mass without inertia (a placeholder?), taken as a point mass" if mass > 0.0 else None
    if least + middle < most * (1.0 - GROSS):
        raise InputError(
            f"{where}: its principal moments of inertia A, B, C violate A + B >= C by more than {GROSS:.0%} of C, "
            "which is no rounding. Give the inertia of a real body."
        )
    if mass == 0.0:
        return "an inertia without mass, taken as it is"
    if least < -ROUNDING * size:
        return "a slightly negative principal moment of inertia, taken as it is"
    if least + middle < most * (1.0 - ROUNDING):
        return "principal moments of inertia that violate the triangle inequality by rounding, taken as they are"
    return None


def as_compiled(
    mass: float, inertia: Array, *, least_mass: float, least_moment: float, balance: bool
) -> tuple[float, Array, bool]:
    """What MuJoCo's compiler makes of a body: bounded below, and where asked for the moments averaged (then True)."""
    moments, axes = np.linalg.eigh(inertia)
    bounded = np.maximum(moments, least_moment) if least_moment > 0.0 else moments
    balanced = balance and 2.0 * bounded.max() > bounded.sum() * (1.0 + ROUNDING)
    if balanced:
        bounded = np.full(3, bounded.mean())
    if not np.array_equal(bounded, moments):
        inertia = axes @ np.diag(bounded) @ axes.T
    return max(mass, least_mass), inertia, balanced
