"""Gains that can be built: a bound on the algebraic loop through E, as a box on the arm's mobility.  [theory §8]

The bound rho(Ms^-1 E) <= g < 1 reads Mhat - g Ms <= X <= Mhat + g Ms with X = Mhat - E, or the same for Y = X^-1. It
implies X > 0 and S > 0. Both sides are used in coordinates where the arm's own inertia is the identity.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexbase.checks import Array, positive_number
from flexbase.errors import InputError
from flexbase.plant import Pose

RADIUS = 0.9  # default bound on the algebraic loop's radius
INSIDE = 1.0 - 1e-5  # share of the bound that designs use, so that a solver's rounding cannot cross it


class Box(NamedTuple):
    """lower <= L^T Y L <= upper, which is rho(Ms^-1 E) <= g.  [theory §8]

    L : Mhat = L L^T, shape (n, n)
    lower, upper : (I + g F)^-1 and (I - g F)^-1 with F = L^-1 Ms L^-T, shape (n, n)
    """

    L: Array
    lower: Array
    upper: Array

    def gain(self, mobility: Array) -> Array:
        """E = Mhat - X of a mobility L^T Y L, symmetric."""
        E = self.L @ (np.eye(len(mobility)) - np.linalg.inv(mobility)) @ self.L.T
        return np.asarray(0.5 * (E + E.T))


def checked_radius(radius: object) -> float:
    """A bound on rho, above 0 and below 1. Raises InputError."""
    g = positive_number("radius", radius, "0 to 1")
    if g >= 1.0:
        raise InputError(
            f"radius: {g:g} must be below 1: at 1 and above, any common delay in the measured acceleration "
            f"destabilises, however small. {RADIUS:g} is the usual choice."
        )
    return g


def mobility_box(pose: Pose, radius: float) -> Box:
    """The box of a pose. Assumes 0 < radius < 1."""
    L = np.asarray(np.linalg.cholesky(pose.Mhat), dtype=float)
    F = np.linalg.solve(L, np.linalg.solve(L, pose.Ms).T)
    eye = np.eye(len(L))
    lower, upper = (np.linalg.inv(eye + sign * radius * INSIDE * 0.5 * (F + F.T)) for sign in (1.0, -1.0))
    return Box(L, 0.5 * (lower + lower.T), 0.5 * (upper + upper.T))


class BoundedGain:
    """E = g Ls W (I + W^2)^(-1/2) Ls^T, Ms = Ls Ls^T: every symmetric W gives rho < g, X > 0, S > 0.  [theory §7]"""

    def __init__(self, pose: Pose, radius: float) -> None:
        self.g = radius * INSIDE
        self.Ls = np.linalg.cholesky(pose.Ms)

    def at(self, W: Array) -> tuple[Array, Array, Array]:
        """E at W; the eigenvectors of W, and the angles whose tangents are its eigenvalues, for `pull_back`."""
        values, vectors = np.linalg.eigh(W)
        angles = np.arctan(values)
        half = self.Ls @ vectors
        return self.g * (half * np.sin(angles)) @ half.T, vectors, angles

    def pull_back(self, slope: Array, vectors: Array, angles: Array) -> Array:
        """dJ/dW from dJ/dE: divided differences of sin against tan, in a form that never cancels."""
        one, other = angles[:, None], angles[None, :]
        ratio = np.cos(one) * np.cos(other) * np.cos(0.5 * (one + other)) / np.cos(0.5 * (one - other))
        half = self.Ls @ vectors
        return np.asarray(self.g * vectors @ (ratio * (half.T @ slope @ half)) @ vectors.T)

    def parameter(self, E: Array, saturation: float) -> Array:
        """W of a gain; eigenvalues of Ls^-1 E Ls^-T beyond a share `saturation` of the bound are drawn back to it."""
        F = np.linalg.solve(self.Ls, np.linalg.solve(self.Ls, E).T) / self.g
        values, vectors = np.linalg.eigh(0.5 * (F + F.T))
        values = np.clip(values, -saturation, saturation)
        return np.asarray((vectors * (values / np.sqrt(1.0 - values**2))) @ vectors.T)
