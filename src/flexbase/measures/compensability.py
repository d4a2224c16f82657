"""Compensability: whether some constant gain can align the one base mode at all."""

from __future__ import annotations

from typing import NamedTuple

from flexbase.measures.registry import Configuration, measure
from flexbase.model.parts import Parts
from flexbase.trace.algebra import Matrix, Scalar, Vector, dot, scale, solve, transpose


class Coupling(NamedTuple):
    """How the one base joint and the arm move each other.  [theory §7]

    z : Jv^-1 Jp, the arm motion that moves the tip as the base does, length n
    y : -Map, how the arm drives the base, length n
    product : y.z
    """

    z: Vector
    y: Vector
    product: Scalar


def coupling(M: Matrix, J: Matrix, parts: Parts) -> Coupling:
    """z, y and y.z. Assumes one base joint, as many task rows as arm joints, and a regular arm."""
    (Jp,), (Map,) = transpose(tuple(map(parts.base, J))), transpose(parts.blocks(M).coupling)
    z, y = solve(tuple(map(parts.arm, J)), Jp), scale(-1.0, Map)
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
    product = coupling(configuration.M, configuration.J, configuration.parts).product
    return 1.0 + product / configuration.inertia.passive[0][0]
