"""Delay and lag that a sampled loop bears beyond its own, from its gain over frequency."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.linear.discrete.disk_margin import grid_of
from flexbase.linear.discrete.system import Discrete

FINE = 8  # points put between two neighbours of the grid


def delay_margin(loop: Discrete) -> float:
    """Smallest further delay, common to all channels, that destabilises u = L u [s]; infinite where none does.

    Where an eigenvalue of L has modulus 1, a delay that turns it to 1 puts a pole on the unit circle. Assumes a stable
    loop.
    """
    frequencies, values = _tracked(loop)
    size = np.log(np.abs(values) + 1e-300)
    margins = [np.inf]
    for i in range(values.shape[1]):
        for j in np.flatnonzero(size[:-1, i] * size[1:, i] < 0.0):
            part = size[j, i] / (size[j, i] - size[j + 1, i])
            omega = frequencies[j] + part * (frequencies[j + 1] - frequencies[j])
            value = values[j, i] + part * (values[j + 1, i] - values[j, i])
            margins.append(float(np.mod(np.angle(value), 2.0 * np.pi) / omega))
    return min(margins)


def lag_margin(loop: Discrete) -> float:
    """Smallest further first-order lag in all channels that destabilises u = L u [s]; infinite where none does.

    L / (1 + j omega T) has an eigenvalue 1 where an eigenvalue of L has real part 1 and imaginary part omega T. Assumes
    a stable loop, and a lag that the hold does not see between samples.
    """
    frequencies, values = _tracked(loop)
    gap = values.real - 1.0
    margins = [np.inf]
    for i in range(values.shape[1]):
        for j in np.flatnonzero(gap[:-1, i] * gap[1:, i] < 0.0):
            part = gap[j, i] / (gap[j, i] - gap[j + 1, i])
            omega = frequencies[j] + part * (frequencies[j + 1] - frequencies[j])
            lag = float((values[j, i] + part * (values[j + 1, i] - values[j, i])).imag / omega)
            if lag > 0.0:
                margins.append(lag)
    return min(margins)


def _tracked(loop: Discrete) -> tuple[Array, np.ndarray]:
    """Eigenvalues of L over a fine grid, each in a column of its own, shape (frequencies, channels)."""
    coarse = grid_of(loop)
    fine = np.unique(
        np.concatenate([np.linspace(a, b, FINE, endpoint=False) for a, b in zip(coarse[:-1], coarse[1:], strict=True)])
    )
    values = np.linalg.eigvals(loop.transfer_function(fine))
    for j in range(1, len(values)):
        order, left = [], list(range(values.shape[1]))
        for before in values[j - 1]:
            nearest = min(left, key=lambda i: abs(values[j, i] - before))
            order.append(nearest)
            left.remove(nearest)
        values[j] = values[j, order]
    return fine, values
