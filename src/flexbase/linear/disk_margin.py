"""How much gain and phase a sampled loop bears, at several channels at once: the symmetric disk margin."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from flexbase.checks import Array
from flexbase.linear.discrete import Discrete

POINTS = 160  # frequencies on a logarithmic grid, beside those next to the poles
AROUND_POLES = np.array([0.9, 0.97, 0.99, 1.0, 1.01, 1.03, 1.1])
SCALINGS = 12  # rounds of balancing the channels
ONE_WAY = 1e-12  # a channel that only hears, or only speaks, is scaled as if it did the other by this share
ROUNDS = 15  # of refining a balance


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
    frequencies = grid_of(sensitivity)
    sizes = structured_norm(shifted.transfer_function(frequencies))
    top = int(np.argmax(sizes))
    low, high = frequencies[max(top - 1, 0)], frequencies[min(top + 1, len(frequencies) - 1)]
    found = minimize_scalar(
        lambda w: -float(structured_norm(shifted.transfer_function(np.array([w])))[0]),
        bounds=(low, high),
        method="bounded",
    )
    size, where = max((float(sizes[top]), float(frequencies[top])), (-float(found.fun), float(found.x)))
    return DiskMargin(1.0 / size, where)


def grid_of(system: Discrete) -> Array:
    """Frequencies up to Nyquist's: a logarithmic grid, and the neighbourhood of every pole [rad/s]."""
    nyquist = np.pi / system.step
    poles = np.linalg.eigvals(system.A) if system.order else np.zeros(0)
    turning = np.abs(np.angle(poles[np.abs(poles) > 1e-6])) / system.step
    near = (turning[turning > 1e-6 * nyquist][:, None] * AROUND_POLES).ravel()
    grid = np.concatenate([np.geomspace(1e-4 * nyquist, nyquist, POINTS), near])
    return np.asarray(np.unique(grid[grid <= nyquist]))


def structured_norm(T: np.ndarray) -> Array:
    """min over positive diagonal D of |D T D^-1|, shape (...), of T of shape (..., channels, channels).

    Osborne's balancing, then the better of it and no scaling: an upper bound of mu for independent complex channels.
    """
    plain = np.linalg.norm(T, 2, axis=(-2, -1))
    if T.shape[-1] == 1:
        return np.asarray(plain)
    d = balancing(T)
    balanced = T * d[..., :, None] / d[..., None, :]
    return np.asarray(np.minimum(plain, np.linalg.norm(balanced, 2, axis=(-2, -1))))


def balancing(T: np.ndarray) -> Array:
    """Osborne's D, shape (..., channels): rows and columns of D T D^-1 weigh the same off the diagonal."""
    channels = T.shape[-1]
    d = np.ones(T.shape[:-1])
    if channels == 1:
        return d
    off = np.abs(T) ** 2 * (1.0 - np.eye(channels))
    for _ in range(SCALINGS):
        for i in range(channels):
            row = np.sqrt(np.einsum("...j,...j->...", off[..., i, :], 1.0 / d**2))
            column = np.sqrt(np.einsum("...j,...j->...", off[..., :, i], d**2))
            floor = ONE_WAY * np.maximum(row, column) + 1e-300
            d[..., i] = np.sqrt(np.maximum(column, floor) / np.maximum(row, floor))
        d /= np.exp(np.log(d).mean(axis=-1, keepdims=True))
    return d


def tighter(T: np.ndarray, d: Array) -> Array:
    """Scalings from which |D T D^-1| does not fall much further, from those of `balancing`; a few matrices at a time.

    Where the largest singular value is simple it is least where its left and right vectors weigh each channel alike.
    """
    best, least = d, np.linalg.norm(T * d[..., :, None] / d[..., None, :], 2, axis=(-2, -1))
    for _ in range(ROUNDS):
        u, s, vh = np.linalg.svd(T * d[..., :, None] / d[..., None, :])
        better = s[..., 0] < least
        least, best = np.where(better, s[..., 0], least), np.where(better[..., None], d, best)
        weight = np.abs(vh[..., 0, :]) + 1e-6, np.abs(u[..., :, 0]) + 1e-6
        d = d * (weight[0] / weight[1]) ** 0.4
    return best
