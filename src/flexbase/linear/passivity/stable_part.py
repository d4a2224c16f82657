"""The stable part of a response as state space, and its Hermitian part over frequency."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from flexbase.checks import Array

NOISE = 1e-11  # of the largest direction of [C, B^T, D]: what is below is rounding, and left out
SPREAD = np.array([-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0])  # seeds around a pole, in damping ratios  [theory §5]


@dataclass(frozen=True, eq=False)
class Port:
    """F(s) = C (s I - A)^-1 B + D with as many outputs as inputs, and A stable.

    A : shape (x, x); B : (x, k); C : (k, x), may be complex; D : (k, k)
    response : F(i omega) of frequencies [rad/s], shape (...,) -> (..., k, k); as accurate as the origin of F allows
    rows : how many outputs there were before directions without a response were left out
    """

    A: Array
    B: Array
    C: np.ndarray
    D: Array
    response: Callable[[Array], np.ndarray]
    rows: int

    def hermitian(self, omega: Array) -> np.ndarray:
        """(F + F*)/2 at frequencies, shape (..., k, k)."""
        F = self.response(omega)
        return np.asarray(0.5 * (F + np.conj(np.swapaxes(F, -1, -2))))

    def least_eigenvalue(self, omega: Array) -> Array:
        """lambda_min of (F + F*)/2, of all rows: 0 at most where directions were left out."""
        if len(self.D) == 0:
            return np.zeros(np.shape(omega))
        least = np.linalg.eigvalsh(self.hermitian(omega))[..., 0]
        return np.minimum(least, 0.0) if len(self.D) < self.rows else least

    def largest_singular_value(self, omega: Array) -> Array:
        """|F| at frequencies."""
        if len(self.D) == 0:
            return np.zeros(np.shape(omega))
        return np.asarray(np.linalg.svd(self.response(omega), compute_uv=False)[..., 0])

    def seeds(self) -> Array:
        """Frequencies around every pole: |l| (1 +- {0, 1/2, 1, 2} zeta).  [theory §5]"""
        poles = np.linalg.eigvals(self.A)
        poles = poles[np.abs(poles) > 0.0]
        found = (np.abs(poles)[:, None] - poles.real[:, None] * SPREAD).ravel()
        return np.unique(found[found > 0.0])


def compressed(port: Port) -> Port:
    """The same without the directions that neither drive nor are driven, by a rank-revealing factorisation.

    They would make the pencils of `popov` singular, and just so for designed plants.
    """
    C = port.C.imag if np.iscomplexobj(port.C) and not port.C.real.any() else port.C
    parts = [part / size for part in (C, port.B.T, port.D, port.D.T) if (size := np.linalg.norm(part)) > 0.0]
    if not parts:
        return Port(port.A, port.B[:, :0], port.C[:0], port.D[:0, :0], port.response, port.rows)
    directions, sizes, _ = np.linalg.svd(np.hstack(parts))
    rank = int(np.sum(sizes > NOISE * sizes[0]))
    if rank == len(port.D):
        return port
    Q = directions[:, :rank]
    return Port(
        port.A, port.B @ Q, Q.T @ port.C, Q.T @ port.D @ Q, lambda omega: Q.T @ port.response(omega) @ Q, port.rows
    )
