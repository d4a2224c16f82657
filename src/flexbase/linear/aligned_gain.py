"""The smallest gain that aligns the one base mode at a chosen frequency, on any number type.  [theory §7]"""

from __future__ import annotations

from flexbase.trace.algebra import (
    Matrix,
    Scalar,
    Vector,
    dot,
    larger,
    matadd,
    matmul,
    matsub,
    matvec,
    norm,
    scale,
    select,
    transpose,
)
from flexbase.trace.eigen import symmetric_eigen

SMALLEST_INERTIA = 1e-3  # of the arm's own, kept in the directions that the targets leave free


def least_gain(Mhat: Matrix, z: Vector, y: Vector, alpha: Scalar) -> Matrix:
    """Smallest ||E||_F with (Mhat - E) z = y/alpha and Mhat - E > 0.

    In the basis [z/|z|, Z] the target fixes all of E but the block Z^T E Z, and X > 0 exactly where
    T = Z^T X Z - Z^T y y^T Z / (alpha y.z) is positive: a projection on positive matrices, by eigenvalues.
    Assumes alpha y.z > 0.
    """
    missing = tuple(x - yi / alpha for x, yi in zip(matvec(Mhat, z), y, strict=True))
    square, twice = dot(z, z), dot(missing, z)
    outer = _outer(missing, z)
    fixed = matsub(
        _scaled(1.0 / square, matadd(outer, transpose(outer))), _scaled(twice / (square * square), _outer(z, z))
    )
    if len(z) == 1:
        return fixed
    Z = _complement(z)
    free = matsub(Mhat, _scaled(1.0 / (alpha * dot(y, z)), _outer(y, y)))
    values, vectors = symmetric_eigen(matmul(matmul(Z, free), transpose(Z)))
    floor = SMALLEST_INERTIA * symmetric_eigen(Mhat).values[0]
    E = fixed
    for value, vector in zip(values, vectors, strict=True):
        direction = matvec(transpose(Z), vector)
        E = matadd(E, _scaled(value - larger(value, floor), _outer(direction, direction)))
    return E


def _complement(z: Vector) -> Matrix:
    """Orthonormal rows orthogonal to z: all but the first of the reflection that carries z to its first axis."""
    size, length = len(z), norm(z)
    first = z[0] + select(z[0] < 0.0, -length, length)
    v = (first, *z[1:])
    factor = 2.0 / dot(v, v)
    return tuple(tuple((1.0 if i == j else 0.0) - factor * (v[i] * v[j]) for j in range(size)) for i in range(1, size))


def _outer(u: Vector, v: Vector) -> Matrix:
    return tuple(scale(x, v) for x in u)


def _scaled(factor: Scalar, A: Matrix) -> Matrix:
    return tuple(scale(factor, row) for row in A)
