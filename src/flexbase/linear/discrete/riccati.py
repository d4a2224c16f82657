"""Algebraic Riccati equations by scipy, with one kind of refusal."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import solve_continuous_are, solve_discrete_are

from flexbase.checks import Array


def continuous(A: Array, B: Array, Q: Array, R: Array) -> Array:
    """Stabilising X of A^T X + X A - X B R^-1 B^T X + Q = 0. Raises numpy.linalg.LinAlgError where there is none."""
    return _solved(solve_continuous_are, A, B, Q, R)


def discrete(A: Array, B: Array, Q: Array, R: Array) -> Array:
    """Stabilising X of A^T X A - X - A^T X B (R + B^T X B)^-1 B^T X A + Q = 0. Raises numpy.linalg.LinAlgError."""
    return _solved(solve_discrete_are, A, B, Q, R)


def _solved(solve: Callable[..., Array], *matrices: Array) -> Array:
    try:
        return np.asarray(solve(*matrices))
    except ValueError as fault:  # so scipy says where its Schur form cannot be put in order
        raise np.linalg.LinAlgError(f"a Riccati equation could not be solved: {fault}") from fault
