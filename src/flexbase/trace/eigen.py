"""Eigenvalues of small symmetric matrices by Jacobi rotations, on any number type: no branch, a fixed count."""

from __future__ import annotations

from typing import NamedTuple

from flexbase.trace.algebra import (
    Matrix,
    Scalar,
    Vector,
    absolute,
    add,
    ldl,
    matmul,
    mul,
    or_one,
    scale,
    select,
    sqrt,
    sub,
    transpose,
)

SWEEPS = {1: 0, 2: 1, 3: 5, 4: 6, 5: 7}  # one rotation diagonalises 2 x 2; the others end below rounding
MOST_SWEEPS = 8


class Eigen(NamedTuple):
    """Eigenvalues, smallest first, and a unit eigenvector for each."""

    values: Vector
    vectors: Matrix


def symmetric_eigen(A: Matrix) -> Eigen:
    """Eigenvalues and eigenvectors of a symmetric A by cyclic Jacobi rotations.  [GV13 §8.5]

    Absolute error a few roundings of |A|.
    """
    size = len(A)
    entries = [list(row) for row in A]
    vectors = [[1.0 if i == j else 0.0 for j in range(size)] for i in range(size)]  # row i: eigenvector i
    for _ in range(SWEEPS.get(size, MOST_SWEEPS)):
        for p in range(size):
            for q in range(p + 1, size):
                _rotate(entries, vectors, p, q)
    return _ascending([entries[i][i] for i in range(size)], [tuple(row) for row in vectors])


def _rotate(A: list[list[Scalar]], vectors: list[list[Scalar]], p: int, q: int) -> None:
    """Turn the plane (p, q) so that A[p][q] vanishes, by the smaller of the two angles."""
    gap, twice = sub(A[q][q], A[p][p]), mul(2.0, A[p][q])
    size = or_one(add(absolute(gap), sqrt(add(mul(gap, gap), mul(twice, twice)))))
    tangent = select(gap < 0.0, -twice / size, twice / size)
    c = 1.0 / sqrt(1.0 + tangent * tangent)
    s = tangent * c
    moved = mul(tangent, A[p][q])
    A[p][p], A[q][q] = sub(A[p][p], moved), add(A[q][q], moved)
    A[p][q] = A[q][p] = 0.0
    for i in range(len(A)):
        if i not in (p, q):
            x, y = A[i][p], A[i][q]
            A[i][p] = A[p][i] = sub(mul(c, x), mul(s, y))
            A[i][q] = A[q][i] = add(mul(s, x), mul(c, y))
    for i in range(len(A)):
        x, y = vectors[p][i], vectors[q][i]
        vectors[p][i], vectors[q][i] = sub(mul(c, x), mul(s, y)), add(mul(s, x), mul(c, y))


def _ascending(values: list[Scalar], vectors: list[Vector]) -> Eigen:
    """Sort by exchanges of neighbours: the same comparisons for every configuration."""
    for end in range(len(values) - 1, 0, -1):
        for i in range(end):
            swap = values[i + 1] < values[i]
            low, high = select(swap, values[i + 1], values[i]), select(swap, values[i], values[i + 1])
            pairs = list(zip(vectors[i], vectors[i + 1], strict=True))
            vectors[i] = tuple(select(swap, y, x) for x, y in pairs)
            vectors[i + 1] = tuple(select(swap, x, y) for x, y in pairs)
            values[i], values[i + 1] = low, high
    return Eigen(tuple(values), tuple(vectors))


def generalised_eigen(A: Matrix, S: Matrix) -> Eigen:
    """Eigenvalues l and vectors phi of A phi = l S phi with phi^T S phi = 1. Assumes S positive definite."""
    inverse = _inverse_cholesky(S)
    values, turned = symmetric_eigen(matmul(matmul(inverse, A), transpose(inverse)))
    return Eigen(values, matmul(turned, inverse))


def _inverse_cholesky(S: Matrix) -> Matrix:
    """L^-1 with S = L L^T, lower triangular."""
    unit, pivots = ldl(S)
    size = len(S)
    rows: list[Vector] = []
    for i in range(size):
        row: list[Scalar] = [1.0 if j == i else 0.0 for j in range(size)]
        for p in range(i):
            for j in range(p + 1):
                row[j] = sub(row[j], mul(unit[i][p], rows[p][j]))
        rows.append(tuple(row))
    return tuple(scale(1.0 / sqrt(pivot), row) for pivot, row in zip(pivots, rows, strict=True))
