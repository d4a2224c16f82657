"""Poles and mode shapes of M q'' + D q' + K q = 0, real ones and complex ones."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.linalg

from flexbase.checks import Array

PROPORTIONAL = 1e-12  # off-diagonal modal damping, relative, below which a mode shape counts as real
RIGID = 1e-6  # of the fastest pole: a double pole at 0 is computed as about 1e-8 of it, the root of rounding


class RealShapes(NamedTuple):
    """Undamped shapes that the damping does not couple: phi^T M phi = I.

    shapes : shape (N, N), a column a mode; stiffness = omega^2 and damping = 2 zeta omega, shape (N,)
    """

    shapes: Array
    stiffness: Array
    damping: Array


class Pole(NamedTuple):
    """A pole l and its shape, psi^T (2 l M + D) psi = 1. A complex pole stands for its conjugate too."""

    value: complex
    shape: np.ndarray


def real_shapes(M: Array, D: Array, K: Array) -> RealShapes | None:
    """Real modes, softest first, or None where the damping couples them (non-proportional damping).

    Assumes M symmetric positive definite.
    """
    stiffness, shapes = scipy.linalg.eigh(K, M)
    modal = shapes.T @ D @ shapes
    coupling = np.abs(modal - np.diag(np.diag(modal))).max(initial=0.0)
    if coupling > PROPORTIONAL * np.abs(modal).max(initial=0.0):
        return None
    return RealShapes(shapes, stiffness, np.diag(modal))


def damped_poles(M: Array, D: Array, K: Array) -> list[Pole]:
    """All poles with Im >= 0 and their normalised shapes, slowest first.

    Assumes distinct poles; a zero pole (a rigid mode) has no normalised shape and is left out.
    """
    N = len(M)
    A = np.block([[np.zeros((N, N)), np.eye(N)], [-np.linalg.solve(M, np.hstack([K, D]))]])
    values, vectors = scipy.linalg.eig(A)
    rigid = RIGID * np.abs(values).max()
    poles = []
    for value, vector in zip(values, vectors.T, strict=True):
        if value.imag < 0.0 or abs(value) <= rigid:
            continue
        psi = vector[:N]
        psi = psi / np.sqrt(psi @ (2.0 * value * M + D) @ psi)
        poles.append(Pole(complex(value), psi))
    return sorted(poles, key=lambda pole: abs(pole.value))
