"""A sampled loop closed by a constant matrix: its poles and disk margins, with slopes by that matrix."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from flexbase.checks import Array, inverse
from flexbase.linear.discrete.disk_margin import balancing, grid_of, scaled, spectral_norm, tighter
from flexbase.linear.discrete.system import ALGEBRAIC, Discrete, series

NEAR = 0.75  # share of the largest from which further peaks and poles count
PEAKS = 6
COARSE = 64  # frequencies on the grid: the closed loop's own poles are added to it


class Piece(NamedTuple):
    """A value that depends on the matrix, and its slope, of the matrix's shape."""

    value: float
    slope: Array


@dataclass(frozen=True, eq=False)
class AffineLoop:
    """u = Theta z, z seen by `estimator` through the plant's measurements y.

    period : the plants that follow each other over a period of the slowest sensor, u to y
    averaged : one plant for frequency responses, u to y
    estimator : y to z; used : measurements that count at the sensors
    """

    period: Sequence[Discrete]
    averaged: Discrete
    estimator: Discrete
    used: tuple[int, ...]

    @cached_property
    def _steps(self) -> list[Discrete]:
        return [series(plant, self.estimator) for plant in self.period]

    @cached_property
    def _grid(self) -> Array:
        return grid_of(series(self.averaged, self.estimator), COARSE)

    @cached_property
    def _responses(self) -> tuple[np.ndarray, np.ndarray]:
        return self._at(self._grid)

    def _at(self, frequencies: Array) -> tuple[np.ndarray, np.ndarray]:
        """P from u to the used measurements, F from these to z, each with frequencies leading."""
        P = self.averaged.select(list(self.used)).transfer_function(frequencies)
        return P, self.estimator.select(inputs=list(self.used)).transfer_function(frequencies)

    def poles(self, theta: Array) -> list[Piece]:
        """Moduli of the closed loop's eigenvalues, a sample each: the largest, and those near it, one of a pair."""
        matrices, through = [], []
        for one in self._steps:
            right = inverse(np.eye(len(one.C)) - one.D @ theta, ALGEBRAIC)
            matrices.append(one.A + one.B @ theta @ right @ one.C)
            through.append((inverse(np.eye(theta.shape[0]) - theta @ one.D, ALGEBRAIC), right))
        count = len(matrices)
        whole = np.linalg.multi_dot(matrices[::-1]) if count > 1 else matrices[0]
        values, right_vectors = np.linalg.eig(whole)
        sizes = np.abs(values)
        left_vectors = np.linalg.pinv(right_vectors)
        order = [int(i) for i in np.argsort(-sizes) if values[i].imag >= 0.0]
        found = []
        for i in order[:PEAKS]:
            before, after = [right_vectors[:, i]], [left_vectors[i]]
            for matrix in matrices[:-1]:
                before.append(matrix @ before[-1])
            for matrix in matrices[:0:-1]:
                after.insert(0, after[0] @ matrix)
            slope = sum(
                np.outer(l @ one.B @ into, out @ one.C @ r)
                for one, (into, out), l, r in zip(self._steps, through, after, before, strict=True)
            )
            size = float(sizes[i])
            turned = np.real(np.conj(values[i]) * slope) / max(size, 1e-12)
            a_sample = size ** (1.0 / count)
            found.append(Piece(a_sample, turned * a_sample / (count * max(size, 1e-12))))
        return found

    def _frequencies(self, theta: Array) -> Array:
        """Where the closed loop's own poles turn, beyond the grid."""
        whole = series(self.averaged, self.estimator)
        right = inverse(np.eye(len(whole.C)) - whole.D @ theta, ALGEBRAIC)
        values = np.linalg.eigvals(whole.A + whole.B @ theta @ right @ whole.C)
        weak = values[(np.abs(values) > 0.8) & (values.imag > 1e-9)]
        turning = np.angle(weak) / whole.step
        return np.concatenate([turning, 0.97 * turning, np.minimum(1.03 * turning, np.pi / whole.step)])

    def margins(self, theta: Array, sensors: bool = True) -> list[Piece]:
        """Disk margins at their tightest frequencies: at the torques, and at the sensors too where asked.

        Slopes take each peak's frequency, and its scaling of the channels, as the best one, where it has no slope of
        its own.
        """
        frequencies = np.concatenate([self._grid, self._frequencies(theta)])
        order = np.argsort(frequencies)
        beyond = self._at(frequencies[len(self._grid) :])
        P, F = (np.concatenate(pair)[order] for pair in zip(self._responses, beyond, strict=True))
        found = []
        for side in (_at_torques, _at_sensors) if sensors else (_at_torques,):
            found += _pieces(*side(theta, P, F))
        return found


def _at_torques(theta: Array, P: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """S - I/2 with S = (I + L)^-1, and left and right in dS = left dTheta right."""
    eye = np.eye(P.shape[2])  # S is regular: a stable loop has no pole on the unit circle
    S = np.linalg.inv(eye - theta @ F @ P)
    return S - 0.5 * eye, S, F @ (P @ S)


def _at_sensors(theta: Array, P: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same where the measurements come in."""
    K = theta @ F
    left = P @ np.linalg.inv(np.eye(P.shape[2]) - K @ P)
    half = 0.5 * np.eye(P.shape[1])
    T = half + left @ K
    return T, left, F @ (T + half)


def _pieces(T: np.ndarray, left: np.ndarray, right: np.ndarray) -> list[Piece]:
    """1 / mu(T) at its peaks; dT = left dTheta right."""
    d = balancing(T)
    balanced = scaled(T, d)
    sizes = np.linalg.norm(balanced, axis=(-2, -1))  # Frobenius', no less than what is wanted
    large = sizes >= NEAR * float(spectral_norm(balanced[np.argmax(sizes)]))
    sizes[large] = spectral_norm(balanced[large])
    inside = np.r_[-np.inf, sizes, -np.inf]
    peaks = np.flatnonzero((sizes >= inside[:-2]) & (sizes >= inside[2:]) & (sizes >= NEAR * sizes.max()))
    peaks = peaks[np.argsort(-sizes[peaks])][:PEAKS]
    d = tighter(T[peaks], d[peaks])
    u, s, vh = np.linalg.svd(scaled(T[peaks], d))
    rows = ((u[:, :, 0].conj() * d)[:, None, :] @ left[peaks])[:, 0]
    columns = (right[peaks] @ (vh[:, 0].conj() / d)[:, :, None])[:, :, 0]
    slopes = -np.real(rows[:, :, None] * columns[:, None, :]) / s[:, :1, None] ** 2
    return [Piece(1.0 / float(size), slope) for size, slope in zip(s[:, 0], slopes, strict=True)]
