"""Is this the inertia of a body that could exist? Refused where it is impossible, noted where it is implausible."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.model.formats.fields import Numbers

INDEFINITE = 1e-4  # of the largest moment: what rounding to four digits can do to the smallest one
ROUNDING = 1e-9


def tensor(xx: float, yy: float, zz: float, xy: float, xz: float, yz: float) -> Array:
    """The symmetric matrix of six moments."""
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def check_inertia(where: str, mass: float, moments: Numbers) -> str | None:
    """A remark on an implausible inertia about the centre of mass, or None. Raises InputError on an impossible one.

    where : names the body in messages
    moments : xx yy zz xy xz yz [kg m^2]
    """
    if mass < 0.0:
        raise InputError(f"{where}: its mass is negative. Give zero or a positive number of kg.")
    least, middle, most = np.linalg.eigvalsh(tensor(*moments)).tolist()
    size = max(abs(least), abs(most))
    if least < -INDEFINITE * size:
        raise InputError(f"{where}: its inertia has a negative principal moment. Correct ixx ... izz.")
    if size == 0.0:
        return "a mass without inertia (a placeholder?), taken as a point mass" if mass > 0.0 else None
    if mass == 0.0:
        return "an inertia without mass, taken as it is"
    if least < -ROUNDING * size:
        return "a slightly negative principal moment of inertia, taken as it is"
    if least + middle < most * (1.0 - ROUNDING):
        return "principal moments of inertia that violate the triangle inequality, taken as they are"
    return None
