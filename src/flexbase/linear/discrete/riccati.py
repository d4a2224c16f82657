"""Algebraic Riccati equations by scipy, with one kind of refusal."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import solve_continuous_are, solve_discrete_are

from flexbase.checks import Array
from flexbase.errors import Unsolvable


def continuous(A: Array, B: Array, Q: Array, R: Array) -> Array:
    """Stabilising X of A^T X + X A - X B R^-1 B^T X + Q = 0. Raises Unsolvable where there is none."""
    return _solved(solve_continuous_are, A, B, Q, R)


def discrete(A: Array, B: Array, Q: Array, R: Array) -> Array:
    """Stabilising X of A^T X A - X - A^T X B (R + B^T X B)^-1 B^T X A + Q = 0. Raises Unsolvable."""
    return _solved(solve_discrete_are, A, B, Q, R)


def _solved(solve: Callable[..., Array], *matrices: Array) -> Array:
    try:
        return np.asarray(solve(*matrices))
    except (np.linalg.LinAlgError, ValueError) as fault:  # ValueError: a Schur form that cannot be put in order
        raise Unsolvable(
            f"a Riccati equation of the design has no stabilising solution: {fault} Give other gains, or another rate."
        ) from fault
