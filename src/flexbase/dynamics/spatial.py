"""Spatial vectors in world axes at the world origin: motions, forces and rigid-body inertia.  [F08 ch 2]

Everything is expressed at one point, so composite bodies are plain sums and no transformation appears twice.
"""

from __future__ import annotations

from typing import NamedTuple

from flexbase.trace.algebra import (
    Matrix,
    Scalar,
    Vector,
    add,
    cross,
    dot,
    matadd,
    matmul,
    matvec,
    minus,
    mul,
    plus,
    scale,
    sub,
)


class Motion(NamedTuple):
    """Angular velocity and the velocity of the body point that passes the world origin."""

    angular: Vector
    linear: Vector


class Force(NamedTuple):
    """Moment about the world origin, and force."""

    moment: Vector
    force: Vector


class SpatialInertia(NamedTuple):
    """Mass, first moment (mass times centre of mass) and second moment, about the world origin."""

    mass: Scalar
    first: Vector
    second: Matrix


ZERO_VECTOR: Vector = (0.0, 0.0, 0.0)
IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
ZERO_MOTION = Motion(ZERO_VECTOR, ZERO_VECTOR)


def sum_of_motions(a: Motion, b: Motion) -> Motion:
    return Motion(plus(a.angular, b.angular), plus(a.linear, b.linear))


def scaled(rate: Scalar, s: Motion) -> Motion:
    return Motion(scale(rate, s.angular), scale(rate, s.linear))


def sum_of_forces(a: Force, b: Force) -> Force:
    return Force(plus(a.moment, b.moment), plus(a.force, b.force))


def power(f: Force, s: Motion) -> Scalar:
    """Work that a force does on a motion, a second."""
    return add(dot(f.moment, s.angular), dot(f.force, s.linear))


def motion_cross(v: Motion, s: Motion) -> Motion:
    """Rate of change of a motion s that is fixed in a body moving with v."""
    return Motion(cross(v.angular, s.angular), plus(cross(v.angular, s.linear), cross(v.linear, s.angular)))


def force_cross(v: Motion, f: Force) -> Force:
    """Rate of change of a force f that is fixed in a body moving with v."""
    return Force(plus(cross(v.angular, f.moment), cross(v.linear, f.force)), cross(v.angular, f.force))


def momentum(body: SpatialInertia, v: Motion) -> Force:
    """Inertia times motion."""
    return Force(
        plus(matvec(body.second, v.angular), cross(body.first, v.linear)),
        minus(scale(body.mass, v.linear), cross(body.first, v.angular)),
    )


def sum_of_inertias(a: SpatialInertia, b: SpatialInertia) -> SpatialInertia:
    return SpatialInertia(add(a.mass, b.mass), plus(a.first, b.first), matadd(a.second, b.second))


def inertia_at_origin(mass: Scalar, com: Vector, inertia: Matrix, rotation: Matrix) -> SpatialInertia:
    """Inertia about the world origin of a body whose frame has `rotation` and whose centre of mass is at `com`."""
    half, first = matmul(rotation, inertia), scale(mass, com)
    moved = [mul(x, y) for x, y in zip(first, com, strict=True)]
    second: list[list[Scalar]] = [[0.0] * 3 for _ in range(3)]
    for i in range(3):
        one, other = moved[i - 1], moved[i - 2]
        second[i][i] = add(dot(half[i], rotation[i]), add(one, other))
        for j in range(i):
            second[i][j] = second[j][i] = sub(dot(half[i], rotation[j]), mul(first[i], com[j]))
    return SpatialInertia(mass, first, tuple(map(tuple, second)))


def point_mass(mass: Scalar, position: Vector) -> SpatialInertia:
    """Inertia about the world origin of a mass at a point."""
    return inertia_at_origin(mass, position, (ZERO_VECTOR,) * 3, IDENTITY)
