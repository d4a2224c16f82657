"""Scalar, vector and matrix algebra on anything that adds, multiplies and divides.

A scalar is a float, a complex number (for exact derivatives by a complex step), a NumPy array (a batch: one entry a
configuration) or a symbol of a tracer. Vectors are tuples of scalars, matrices tuples of rows. Sums and products with
a literal 0 or 1 are not carried out, so constant geometry folds away.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

Scalar = Any
Vector = Sequence[Scalar]
Matrix = Sequence[Sequence[Scalar]]


def add(x: Scalar, y: Scalar) -> Scalar:
    if type(x) is float and x == 0.0:
        return y
    if type(y) is float and y == 0.0:
        return x
    return x + y


def sub(x: Scalar, y: Scalar) -> Scalar:
    if type(y) is float and y == 0.0:
        return x
    if type(x) is float and x == 0.0:
        return -y
    return x - y


def mul(x: Scalar, y: Scalar) -> Scalar:
    if type(x) is float:
        if x == 0.0:
            return 0.0
        if x == 1.0:
            return y
    if type(y) is float:
        if y == 0.0:
            return 0.0
        if y == 1.0:
            return x
    return x * y


def sin(x: Scalar) -> Scalar:
    return math.sin(x) if isinstance(x, float) else _of_many("sin", x)


def cos(x: Scalar) -> Scalar:
    return math.cos(x) if isinstance(x, float) else _of_many("cos", x)


def sqrt(x: Scalar) -> Scalar:
    return math.sqrt(x) if isinstance(x, float) else _of_many("sqrt", x)


def absolute(x: Scalar) -> Scalar:
    return abs(x) if isinstance(x, float) else _of_many("fabs", x)


def atan2(y: Scalar, x: Scalar) -> Scalar:
    if isinstance(y, float) and isinstance(x, float):
        return math.atan2(y, x)
    if _is_symbol(x) or _is_symbol(y):
        return _symbolic().atan2(y, x)
    return np.arctan2(y, x)


def select(condition: Scalar, x: Scalar, y: Scalar) -> Scalar:
    """x where a comparison holds, else y: nothing of the other, not even its NaN, is let through."""
    if isinstance(condition, bool | np.bool_):
        return x if condition else y
    if _is_symbol(condition):
        return _symbolic().if_else(condition, x, y)
    return np.where(condition, x, y)


def smaller(x: Scalar, y: Scalar) -> Scalar:
    return select(y < x, y, x)


def larger(x: Scalar, y: Scalar) -> Scalar:
    return select(y > x, y, x)


def _of_many(name: str, x: Scalar) -> Scalar:
    """A function of a batch, by NumPy, or of a tracer's symbol."""
    return getattr(_symbolic() if _is_symbol(x) else np, name)(x)


def _is_symbol(x: Scalar) -> bool:
    return type(x).__module__.startswith("casadi")


def _symbolic() -> Any:
    import casadi  # only where its symbols are already about

    return casadi


def plus(u: Vector, v: Vector) -> Vector:
    return tuple(add(x, y) for x, y in zip(u, v, strict=True))


def minus(u: Vector, v: Vector) -> Vector:
    return tuple(sub(x, y) for x, y in zip(u, v, strict=True))


def scale(factor: Scalar, v: Vector) -> Vector:
    return tuple(mul(factor, x) for x in v)


def dot(u: Vector, v: Vector) -> Scalar:
    total: Scalar = 0.0
    for x, y in zip(u, v, strict=True):
        if (type(x) is float and x == 0.0) or (type(y) is float and y == 0.0):
            continue  # most terms of a spatial product: skipped here rather than by two calls
        total = add(total, mul(x, y))
    return total


def norm(v: Vector) -> Scalar:
    return sqrt(dot(v, v))


def cross(u: Vector, v: Vector) -> Vector:
    return (
        sub(mul(u[1], v[2]), mul(u[2], v[1])),
        sub(mul(u[2], v[0]), mul(u[0], v[2])),
        sub(mul(u[0], v[1]), mul(u[1], v[0])),
    )


def transpose(A: Matrix) -> Matrix:
    return tuple(zip(*A, strict=True))


def matvec(A: Matrix, x: Vector) -> Vector:
    return tuple(dot(row, x) for row in A)


def matmul(A: Matrix, B: Matrix) -> Matrix:
    columns = transpose(B)
    return tuple(tuple(dot(row, column) for column in columns) for row in A)


def matadd(A: Matrix, B: Matrix) -> Matrix:
    return tuple(plus(a, b) for a, b in zip(A, B, strict=True))


def matsub(A: Matrix, B: Matrix) -> Matrix:
    return tuple(minus(a, b) for a, b in zip(A, B, strict=True))


def ldl(A: Matrix) -> tuple[Matrix, Vector]:
    """Unit lower triangular L and pivots d with A = L diag(d) L^T, of a symmetric matrix.

    A is positive definite exactly when every pivot is positive, so a batch can be judged before anything is divided by
    a root. Divides by the pivots: the caller decides what a nonpositive one means.
    """
    size = len(A)
    L = [[1.0 if i == j else 0.0 for j in range(size)] for i in range(size)]
    d: list[Scalar] = []
    for j in range(size):
        pivot = A[j][j]
        for p in range(j):
            pivot = sub(pivot, mul(mul(L[j][p], L[j][p]), d[p]))
        d.append(pivot)
        for i in range(j + 1, size):
            entry = A[i][j]
            for p in range(j):
                entry = sub(entry, mul(mul(L[i][p], L[j][p]), d[p]))
            L[i][j] = entry / pivot
    return L, tuple(d)


def solve_ldl(L: Matrix, d: Vector, b: Vector) -> Vector:
    """x with L diag(d) L^T x = b."""
    size = len(d)
    x = list(b)
    for i in range(size):
        for j in range(i):
            x[i] = sub(x[i], mul(L[i][j], x[j]))
    x = [x[i] / d[i] for i in range(size)]
    for i in reversed(range(size)):
        for j in range(i + 1, size):
            x[i] = sub(x[i], mul(L[j][i], x[j]))
    return tuple(x)


def stack(A: Any) -> np.ndarray:
    """Nested scalars as one array, batch axes first: a (k, n) matrix of batches of length B becomes (B, k, n)."""
    shape, level = [], A
    while isinstance(level, list | tuple):
        shape.append(len(level))
        level = level[0] if level else 0.0
    leaves = list(_leaves(A))
    if not leaves:
        return np.zeros(shape)
    if all(type(leaf) is float for leaf in leaves):
        return np.array(leaves).reshape(shape)
    flat = np.stack(np.broadcast_arrays(*leaves), axis=-1)
    return flat.reshape(*flat.shape[:-1], *shape)


def _leaves(A: Any) -> Iterator[Scalar]:
    if isinstance(A, list | tuple):
        for part in A:
            yield from _leaves(part)
    else:
        yield A


def unstack(array: Any, depth: int) -> Any:
    """The inverse of `stack`: the last `depth` axes as nested tuples of scalars, each a batch (or a float)."""
    array = np.asarray(array)
    if depth == 0:
        return float(array) if array.ndim == 0 and array.dtype == np.float64 else array
    moved = np.moveaxis(array, -depth, 0)
    return tuple(unstack(part, depth - 1) for part in moved)


def or_one(length: Scalar) -> Scalar:
    """A length that may be divided by: itself, or one where it is zero."""
    return length + (length == 0.0)


def solve(A: Matrix, b: Vector) -> Vector:
    """x with A x = b for a regular square A, by Gram-Schmidt: stable without a choice of pivots."""
    columns, size = [list(column) for column in transpose(A)], len(b)
    rest, triangle, sides = list(b), [[0.0] * size for _ in range(size)], [0.0] * size
    for j in range(size):
        triangle[j][j] = length = norm(columns[j])
        unit = [x / length for x in columns[j]]
        for later in range(j + 1, size):
            triangle[j][later] = overlap = dot(unit, columns[later])
            columns[later] = [sub(x, mul(overlap, u)) for x, u in zip(columns[later], unit, strict=True)]
        sides[j] = dot(unit, rest)
        rest = [sub(x, mul(sides[j], u)) for x, u in zip(rest, unit, strict=True)]
    x: list[Scalar] = [0.0] * size
    for i in reversed(range(size)):
        known = dot(triangle[i][i + 1 :], x[i + 1 :])
        x[i] = sub(sides[i], known) / triangle[i][i]
    return tuple(x)


def independence(rows: Matrix) -> Scalar:
    """How far the rows of a matrix are from linear dependence: 0 to 1, without a division by what may vanish.

    The smallest part of a row that is orthogonal to those before it, over the longest row; at least the ratio of the
    extreme singular values.
    """
    units: list[Vector] = []
    least: Scalar = 0.0
    longest: Scalar = 0.0
    for i, row in enumerate(rows):
        rest: Vector = tuple(row)
        for unit in units:
            rest = minus(rest, scale(dot(unit, rest), unit))
        length, whole = norm(rest), norm(row)
        units.append(scale(1.0 / or_one(length), rest))
        least, longest = (smaller(length, least), larger(whole, longest)) if i else (length, whole)
    return least / or_one(longest)
