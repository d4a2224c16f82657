"""The reduced form: the arm eliminated, an m x m problem left, on any number type.  [theory §3]"""

from __future__ import annotations

from typing import NamedTuple

from flexbase.model.parts import Parts
from flexbase.trace.algebra import (
    Matrix,
    Scalar,
    Vector,
    dot,
    ldl,
    matmul,
    matsub,
    matvec,
    norm,
    or_one,
    scale,
    solve_ldl,
    sqrt,
    transpose,
)


class Reduced(NamedTuple):
    """P(s) = R0/s^2 - U (S s^2 + Dp s + Kp)^-1 V^T, with X = Mhat - E.  [theory §3]

    R0 : rigid mode Jv X^-1 Jv^T, k x k
    U : Jp - V, how the base moves the tip, k x m
    V : Jv X^-1 Map, how the tip force drives the base, k x m
    S : Mpp - Mpa X^-1 Map, effective base inertia, m x m
    W : X^-1 Map, how the arm follows the base, n x m
    pivots : of X; all positive exactly where X is positive definite
    """

    R0: Matrix
    U: Matrix
    V: Matrix
    S: Matrix
    W: Matrix
    pivots: Vector


class RealMode(NamedTuple):
    """A mode with a real shape phi, phi^T S phi = 1: its residue is a b^T.  [theory §4]

    a : output shape -U phi, how the mode moves the tip (length k)
    b : input shape V phi, how the tip force drives the mode (length k)
    """

    a: Vector
    b: Vector
    frequency: Scalar
    damping_ratio: Scalar


def reduce_arm(M: Matrix, J: Matrix, parts: Parts, E: Matrix | None = None) -> Reduced:
    """Eliminate the arm from M (N x N) and J (k x N); E (n x n) is taken from the arm's inertia.

    Assumes that damping and stiffness act on the base alone, and X = Mhat - E without a zero pivot.
    """
    (Mpp, Map, Mhat), m = parts.blocks(M), len(parts.passive)
    X: Matrix = Mhat if E is None else matsub(Mhat, E)
    Jp, Jv = tuple(map(parts.base, J)), tuple(map(parts.arm, J))
    L, pivots = ldl(X)
    W = transpose(tuple(solve_ldl(L, pivots, column) for column in transpose(Map))) if m else tuple(() for _ in X)
    force = transpose(tuple(solve_ldl(L, pivots, row) for row in Jv))
    V = matmul(Jv, W) if m else tuple(() for _ in Jv)
    return Reduced(
        R0=matmul(Jv, force),
        U=matsub(Jp, V),
        V=V,
        S=matsub(Mpp, matmul(transpose(Map), W)) if m else (),
        W=W,
        pivots=pivots,
    )


def single_mode(reduced: Reduced, stiffness: Scalar, damping: Scalar) -> RealMode:
    """The one mode of a one-joint base, at any damping: omega^2 = Kp/S, R_1 = -U V^T / S.  [theory §3]

    Assumes S > 0.
    """
    root = sqrt(reduced.S[0][0])
    return RealMode(
        a=tuple(-u[0] / root for u in reduced.U),
        b=tuple(v[0] / root for v in reduced.V),
        frequency=sqrt(stiffness) / root,
        damping_ratio=damping / (2.0 * sqrt(stiffness) * root),
    )


def shaped_mode(reduced: Reduced, phi: Vector, stiffness: Scalar, damping: Scalar) -> RealMode:
    """A mode with known real shape phi, phi^T S phi = 1, phi^T Kp phi = stiffness, phi^T Dp phi = damping."""
    frequency = sqrt(stiffness)
    return RealMode(
        a=scale(-1.0, matvec(reduced.U, phi)),
        b=matvec(reduced.V, phi),
        frequency=frequency,
        damping_ratio=damping / (2.0 * frequency),
    )


def robustness(a: Vector, b: Vector) -> Scalar:
    """w = lambda_min(R + R^T) of R = a b^T: a.b - |a||b|, and 2 a b for one task row.  [U03 eq 9, theory §4]

    Written as -|a||b| |a/|a| - b/|b||^2 / 2, which keeps its digits where a and b align.
    """
    if len(a) == 1:
        return 2.0 * (a[0] * b[0])
    length_a, length_b = norm(a), norm(b)
    gap = misalignment(a, b)
    return -0.5 * (length_a * length_b) * dot(gap, gap)


def alignment(a: Vector, b: Vector) -> Scalar:
    """cos(a, b) in [-1, 1], the scale-free companion of w; without meaning where a = 0 or b = 0.  [theory §4]"""
    gap = misalignment(a, b)
    return 1.0 - 0.5 * dot(gap, gap)


def misalignment(a: Vector, b: Vector) -> Vector:
    """a/|a| - b/|b|; a vector of zeros is left as it is."""
    length_a, length_b = or_one(norm(a)), or_one(norm(b))
    return tuple(x / length_a - y / length_b for x, y in zip(a, b, strict=True))
