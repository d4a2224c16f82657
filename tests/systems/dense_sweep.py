"""The lowest eigenvalue of a response's Hermitian part, and its largest gain, by brute force: a sweep, then zooms."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

Response = Callable[[np.ndarray], np.ndarray]  # frequencies (w,) -> F(i w), (w, k, k)


class Plant(NamedTuple):
    """-U (S s^2 + D s + K)^-1 V^T: a reduced form without its rigid motion."""

    S: np.ndarray
    D: np.ndarray
    K: np.ndarray
    U: np.ndarray
    V: np.ndarray

    def response(self, omega: np.ndarray) -> np.ndarray:
        """Force to velocity, with the matrices as they are."""
        s = 1j * omega[:, None, None]
        Z = self.S * s * s + self.D * s + self.K
        return -s * (self.U @ np.linalg.solve(Z, np.broadcast_to(self.V.T + 0j, (len(omega), *self.V.T.shape))))

    def poles(self) -> np.ndarray:
        """Of Z(s), with Im >= 0."""
        m = len(self.S)
        A = np.block([[np.zeros((m, m)), np.eye(m)], [-np.linalg.solve(self.S, np.hstack([self.K, self.D]))]])
        found = np.linalg.eigvals(A)
        return found[found.imag >= 0.0]


KINDS = ("unrelated", "aligned", "nearly aligned", "turned")


def random_plant(rng: np.random.Generator, m: int, k: int, kind: str) -> Plant:
    """Full matrices, so that the damping couples the modes; damping ratios from 1e-4 to beyond 1.

    kind : of V against -U: unrelated, a positive multiple, that to 1e-3, or turned among the base joints
    """

    def definite(least: float) -> np.ndarray:
        root = rng.normal(size=(m, m))
        return root @ root.T + least * np.eye(m)

    S, K, D = definite(0.3), 1e4 * definite(0.1), 10.0 ** rng.uniform(-1.0, 1.7) * definite(0.02)
    U = rng.normal(size=(k, m))
    V = {
        "unrelated": rng.normal(size=(k, m)),
        "aligned": -rng.uniform(0.1, 2.0) * U,
        "nearly aligned": -U * (1.0 + 1e-3 * rng.normal(size=(k, m))),
        "turned": -U @ (np.eye(m) + 0.3 * rng.normal(size=(m, m))),
    }[kind]
    return Plant(S, D, K, U, V)


def grid(poles: np.ndarray, points: int = 250) -> np.ndarray:
    """Six decades, and 2 `points` about every pole down to a thousandth of its width."""
    size = np.abs(poles)
    around = np.geomspace(1e-3, 30.0, points)
    around = np.concatenate([-around, [0.0], around])
    lines = [abs(pole) + around * abs(pole.real) for pole in poles]
    omega = np.unique(np.concatenate([*lines, np.geomspace(1e-3 * size.min(), 1e3 * size.max(), 6 * points)]))
    return omega[omega > 0.0]


def lowest(curve: Callable[[np.ndarray], np.ndarray], omega: np.ndarray, zooms: int = 5) -> float:
    """The lowest value over a grid, its six lowest local minima looked at more closely each time by a factor of 20."""
    values = curve(omega)
    dips = np.flatnonzero((values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:])) + 1
    best = float(values.min())
    for dip in dips[np.argsort(values[dips])][:6]:
        left, right = omega[dip - 1], omega[dip + 1]
        for _ in range(zooms):
            closer = np.linspace(left, right, 41)
            found = curve(closer)
            at = int(found.argmin())
            best = min(best, float(found[at]))
            left, right = closer[max(at - 1, 0)], closer[min(at + 1, 40)]
    return best


def least_eigenvalue(response: Response, omega: np.ndarray) -> np.ndarray:
    F = response(omega)
    return np.linalg.eigvalsh(0.5 * (F + np.conj(np.swapaxes(F, 1, 2))))[:, 0]


def shortage_and_gain(response: Response, omega: np.ndarray) -> tuple[float, float]:
    """min(inf lambda_min of the Hermitian part, 0), and max of the largest singular value."""
    least = lowest(lambda w: least_eigenvalue(response, w), omega)
    gain = -lowest(lambda w: -np.linalg.svd(response(w), compute_uv=False)[:, 0], omega)
    return min(least, 0.0), gain
