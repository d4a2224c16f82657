"""Gain and passivity indices of a response, over all frequencies or a band of them.  [theory §5]"""

from __future__ import annotations

import numpy as np
import scipy.linalg

from flexbase.checks import Array
from flexbase.linear.passivity.level_search import EVERYWHERE, Interval, Lowest, lowest
from flexbase.linear.passivity.popov import Popov
from flexbase.linear.passivity.stable_part import Port, compressed

SKEW = 1e-9  # relative skew part at an end of the frequency axis from which the output index has no lower bound
END = 1e5  # how far beyond the slowest and the fastest pole the output index is followed; its limits are met to 1e-10
NOTHING = Lowest(0.0, 0.0, 0, True)


def largest_gain(port: Port, band: Interval = EVERYWHERE) -> Lowest:
    """max |F(i omega)| over a band [rad/s], and where it is taken; 0 without a response."""
    seeds = port.seeds()
    rough = float(port.largest_singular_value(np.append(seeds, 0.0)).max()) if len(port.D) else 0.0
    if rough == 0.0:
        return NOTHING
    popov = Popov(port, rough)
    limit = float(np.linalg.norm(port.D, 2))
    found = lowest(
        lambda omega: -port.largest_singular_value(omega),
        lambda level: popov(1.0, 0.0, -level * level),
        seeds,
        rough,
        band=band,
        limit=-limit,
    )
    return found._replace(value=-found.value)


def input_index(port: Port, gain: float, band: Interval = EVERYWHERE) -> Lowest:
    """The lowest lambda_min((F + F*)/2) over a band, and where.

    The feedthrough that may be taken off before F stops being positive real; negative, what must be added.

    gain : the size of F, to which the search is exact: max |F|
    """
    if gain == 0.0:
        return NOTHING
    popov = Popov(port, gain)
    limit = float(np.linalg.eigvalsh(0.5 * (port.D + port.D.T))[0])
    return lowest(
        port.least_eigenvalue,
        lambda level: popov(0.0, 1.0, -2.0 * level),
        port.seeds(),
        gain,
        band=band,
        limit=min(limit, 0.0) if len(port.D) < port.rows else limit,
    )


def output_index(port: Port, gain: float, rigid: Array | None = None) -> float:
    """The largest rho with (G + G*)/2 >= rho G*G at all frequencies, G = R0/s + F.  [theory §5]

    The velocity feedback that may be taken off; negative, what must be added; -infinity where none is enough.
    Assumes F strictly proper and, where `rigid` R0 >= 0 (k x k) is not zero, of full rank and F not compressed.
    At each frequency rho is lambda_min of the Hermitian part of G^-1; the ends of the axis are met as limits.
    """
    R0 = np.zeros((port.rows, port.rows)) if rigid is None else rigid
    if not R0.any():
        port = compressed(port)  # directions without a response bear any feedback
    if not len(port.A) or not len(port.D):
        return 0.0
    fast = port.C @ port.B + (R0 if R0.any() else 0.0)
    if _skewed(fast) or np.linalg.cond(fast) > 1.0 / SKEW:
        return -np.inf
    whole = _with_rigid(port, R0)
    poles = np.abs(np.linalg.eigvals(port.A))
    if not R0.any() and _skewed(np.linalg.solve(port.A.T, port.C.T).T @ np.linalg.solve(port.A, port.B)):
        return -np.inf
    band = float(poles.min() / END), float(poles.max() * END)

    def curve(omega: Array) -> Array:
        inverse = np.linalg.inv(whole.response(omega))
        return np.asarray(np.linalg.eigvalsh(0.5 * (inverse + np.conj(np.swapaxes(inverse, -1, -2))))[..., 0])

    popov = Popov(whole, gain)
    scale = max(1.0 / gain, abs(float(curve(port.seeds()).min())))
    found = lowest(curve, lambda level: popov(-2.0 * level, 1.0, 0.0), port.seeds(), scale, band=band, limit=np.inf)
    return min(found.value, 0.0) if R0.any() else found.value


def skewness(matrix: Array) -> float:
    """|T - T^T| / (2 |T|), 0 where T = 0."""
    size = float(np.linalg.norm(matrix))
    return float(np.linalg.norm(matrix - matrix.T)) / (2.0 * size) if size > 0.0 else 0.0


def _skewed(matrix: Array) -> bool:
    return skewness(matrix) > SKEW


def _with_rigid(port: Port, R0: Array) -> Port:
    """R0/s + F. Assumes a port of all rows where R0 is not zero."""
    if not R0.any():
        return port
    sizes, axes = np.linalg.eigh(R0)
    root = axes * np.sqrt(np.maximum(sizes, 0.0))
    k = len(R0)

    def response(omega: Array) -> np.ndarray:
        return np.asarray(R0 / (1j * np.asarray(omega)[..., None, None]) + port.response(omega))

    return Port(
        scipy.linalg.block_diag(np.zeros((k, k)), port.A),
        np.vstack([root.T, port.B]),
        np.hstack([root, port.C]),
        port.D,
        response,
        port.rows,
    )
