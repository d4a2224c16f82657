"""How much gain and phase a sampled loop bears, at several channels at once: the symmetric disk margin."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from flexbase.checks import Array
from flexbase.linear.discrete import Discrete

POINTS = 160  # frequencies on a logarithmic grid, beside those next to the poles
AROUND_POLES = np.array([0.9, 0.97, 0.99, 1.0, 1.01, 1.03, 1.1])
SCALINGS = 12  # rounds of balancing the channels


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
    shifted = Discrete(
        sensitivity.A, sensitivity.B, sensitivity.C, sensitivity.D - 0.5 * np.eye(len(sensitivity.D)), sensitivity.step
    )
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
    channels = T.shape[-1]
    plain = np.linalg.norm(T, 2, axis=(-2, -1))
    if channels == 1:
        return np.asarray(plain)
    size = np.abs(T) ** 2
    off = size * (1.0 - np.eye(channels))
    d = np.ones(T.shape[:-1])
    for _ in range(SCALINGS):
        for i in range(channels):
            row = np.sqrt(np.einsum("...j,...j->...", off[..., i, :], 1.0 / d**2))
            column = np.sqrt(np.einsum("...j,...j->...", off[..., :, i], d**2))
            d[..., i] = np.sqrt(np.maximum(column, 1e-300) / np.maximum(row, 1e-300))
        d /= np.exp(np.log(d).mean(axis=-1, keepdims=True))
    d = np.clip(d, 1e-6, 1e6)
    balanced = T * d[..., :, None] / d[..., None, :]
    return np.asarray(np.minimum(plain, np.linalg.norm(balanced, 2, axis=(-2, -1))))
