"""Compensability: whether some constant gain can align the one base mode at all."""

from __future__ import annotations

from typing import NamedTuple

from flexbase.measures.registry import Configuration, measure
from flexbase.trace.algebra import Matrix, Scalar, Vector, dot, scale, solve


class Coupling(NamedTuple):
    """How the one base joint and the arm move each other.  [theory §7]

    z : Jv^-1 Jp, the arm motion that moves the tip as the base does, length n
    y : -Map, how the arm drives the base, length n
    product : y.z
    """

    z: Vector
    y: Vector
    product: Scalar


def coupling(M: Matrix, J: Matrix) -> Coupling:
    """z, y and y.z. Assumes one base joint, as many task rows as arm joints, and a regular arm."""
    z = solve(tuple(row[1:] for row in J), tuple(row[0] for row in J))
    y = scale(-1.0, tuple(row[0] for row in M[1:]))
    return Coupling(z, y, dot(y, z))


@measure(
    "compensability",
    unit="1",
    purpose="1 + y.z/Mpp: positive where a gain can align the one mode",
    zero_is="the border beyond which no gain aligns the mode",
    needs=lambda m, n, k: None if m == 1 and k == n else "one base joint and as many task rows as arm joints",
)
def compensability(configuration: Configuration) -> Scalar:
    """1 + y.z/Mpp: a gain E with w = 0 exists where this is positive.  [theory §7]

    Assumes m = 1, k = n and a regular arm. At exactly 1 (y.z = 0) only an infinite gain would do.
    """
    return 1.0 + coupling(configuration.M, configuration.J).product / configuration.M[0][0]
