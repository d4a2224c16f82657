"""How much gain and phase a sampled loop bears, at several channels at once: the symmetric disk margin."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from flexbase.checks import Array
from flexbase.linear.discrete.system import Discrete

POINTS = 160  # frequencies on a logarithmic grid, beside those next to the poles
AROUND_POLES = np.array([0.9, 0.97, 0.99, 1.0, 1.01, 1.03, 1.1])
ZOOMS, ZOOMED = 3, 17  # of the grid around the maximum, and points in each
SCALINGS = 12  # rounds of balancing the channels, at most
SETTLED = 1e-2  # change of D^2 in a round that is the last
ONE_WAY = 1e-24  # a channel that only hears, or only speaks, is scaled as if it did the other by this share of power
ROUNDS = 6  # of refining a balance


class DiskMargin(NamedTuple):
    """alpha: gains from (2 - alpha)/(2 + alpha) to its inverse, phases to 2 atan(alpha/2), in every channel at once.

    alpha : 0 for an unstable loop; frequency : where it is smallest [rad/s]
    """

    alpha: float
    frequency: float


def disk_margin(sensitivity: Discrete) -> DiskMargin:
    """alpha = 1 / max over omega of mu(S - I/2) for independent channels, from a stable S = (I + L)^-1.

    mu is bounded from above by balancing the channels, so the margin is a promise (a few percent short of mu's). The
    maximum is looked for on a grid and then refined; between grid points poles are not missed, since their frequencies
    are on it.
    """
    shifted = replace(sensitivity, D=sensitivity.D - 0.5 * np.eye(len(sensitivity.D)))
    size, where = highest(lambda w: structured_norm(shifted.transfer_function(w)), grid_of(sensitivity))
    return DiskMargin(1.0 / size, where)


def highest(size: Callable[[Array], Array], frequencies: Array) -> tuple[float, float]:
    """The largest value over sorted frequencies and, near it, between them; and where [rad/s]."""
    best = (0.0, 0.0)
    for _ in range(1 + ZOOMS):
        sizes = size(frequencies)
        top = int(np.argmax(sizes))
        best = max(best, (float(sizes[top]), float(frequencies[top])))
        ends = frequencies[max(top - 1, 0)], frequencies[min(top + 1, len(frequencies) - 1)]
        frequencies = np.linspace(*ends, ZOOMED)
    return best


def grid_of(system: Discrete, points: int = POINTS) -> Array:
    """Frequencies up to Nyquist's: a logarithmic grid, and the neighbourhood of every pole [rad/s]."""
    nyquist = np.pi / system.step
    poles = np.linalg.eigvals(system.A) if system.order else np.zeros(0)
    turning = np.abs(np.angle(poles[np.abs(poles) > 1e-6])) / system.step
    near = (turning[turning > 1e-6 * nyquist][:, None] * AROUND_POLES).ravel()
    grid = np.concatenate([np.geomspace(1e-4 * nyquist, nyquist, points), near])
    return np.asarray(np.unique(grid[grid <= nyquist]))


def structured_norm(T: np.ndarray) -> Array:
    """min over positive diagonal D of |D T D^-1|, shape (...), of T of shape (..., channels, channels).

    Osborne's balancing, then the better of it and no scaling: an upper bound of mu for independent complex channels,
    and the minimum itself for two.
    """
    return np.minimum(spectral_norm(T), spectral_norm(scaled(T, balancing(T))))


def spectral_norm(T: np.ndarray) -> Array:
    """The largest singular value, shape (...), of T of shape (..., channels, channels)."""
    if T.shape[-1] == 2:  # singular values have |T|_F^2 as their sum of squares, and |det T| as their product
        total = (np.abs(T) ** 2).sum(axis=(-2, -1))
        twice = 2.0 * np.abs(T[..., 0, 0] * T[..., 1, 1] - T[..., 0, 1] * T[..., 1, 0])
        return np.asarray(np.sqrt(0.5 * (total + np.sqrt(np.maximum(total - twice, 0.0) * (total + twice)))))
    return np.asarray(np.sqrt(np.linalg.eigvalsh(T.conj().swapaxes(-1, -2) @ T)[..., -1]))


def scaled(T: np.ndarray, d: Array) -> np.ndarray:
    """D T D^-1."""
    return np.asarray(T * (d[..., :, None] / d[..., None, :]))


def balancing(T: np.ndarray) -> Array:
    """Osborne's D, shape (..., channels): rows and columns of D T D^-1 weigh the same off the diagonal."""
    channels = T.shape[-1]
    weight = np.ascontiguousarray(np.moveaxis(np.abs(T) ** 2, (-2, -1), (0, 1)))
    weight[range(channels), range(channels)] = 0.0
    squares = np.ones((channels, *T.shape[:-2]))  # of D
    for _ in range(SCALINGS if channels > 1 else 0):
        before = squares.copy()
        for i in range(channels):
            row = (weight[i] / squares).sum(axis=0) + 1e-300
            column = (weight[:, i] * squares).sum(axis=0) + 1e-300
            squares[i] = np.sqrt(np.minimum(np.maximum(column / row, ONE_WAY), 1.0 / ONE_WAY))
        if np.all(np.abs(squares / before - 1.0) < SETTLED):
            break
    d = np.moveaxis(np.sqrt(squares), 0, -1)
    return np.asarray(d / np.exp(np.log(d).mean(axis=-1, keepdims=True)))


def tighter(T: np.ndarray, d: Array) -> Array:
    """Scalings from which |D T D^-1| does not fall much further, from those of `balancing`; a few matrices at a time.

    Where the largest singular value is simple it is least where its left and right vectors weigh each channel alike.
    """
    if T.shape[-1] <= 2:
        return d
    best, least = d, spectral_norm(scaled(T, d))
    for _ in range(ROUNDS):
        u, s, vh = np.linalg.svd(scaled(T, d))
        better = s[..., 0] < least
        least, best = np.where(better, s[..., 0], least), np.where(better[..., None], d, best)
        weight = np.abs(vh[..., 0, :]) + 1e-6, np.abs(u[..., :, 0]) + 1e-6
        d = d * (weight[0] / weight[1]) ** 0.4
    return best
