"""The lowest value of a curve over a band of frequencies, and where it lies below a level, by crossings of levels."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from flexbase.checks import Array

ROUNDS = 12
RESOLUTION = 2e-9  # of the curve's scale: no dip deeper than this is missed
FARTHER = 4.0  # step of the search for the end of an interval beyond the last crossing
STEPS = 40

Curve = Callable[[Array], Array]
Crossings = Callable[[float], Array]
Interval = tuple[float, float]
EVERYWHERE: Interval = (0.0, np.inf)


class Lowest(NamedTuple):
    """The lowest value, the frequency where it is taken, the levels looked at, and whether the last one was clear."""

    value: float
    at: float
    rounds: int
    settled: bool


def lowest(
    curve: Curve, crossings: Crossings, seeds: Array, scale: float, *, band: Interval = EVERYWHERE, limit: float = 0.0
) -> Lowest:
    """The lowest value of a continuous curve over a closed band.

    Below the best value so far by RESOLUTION there is either no crossing, and the search is over, or the curve dips
    between two crossings, and what is found there is the next best value.  [theory §5]

    crossings : of a level, sorted candidates among which are all frequencies where the curve meets it
    scale : the curve's size; limit : its value at infinity
    """
    low, high = band
    omega = np.unique(np.concatenate([_ends(band), seeds[(seeds > low) & (seeds < high)]]))
    values = curve(omega)
    best, at = float(values.min()), float(omega[values.argmin()])
    if np.isinf(high) and limit < best:
        best, at = limit, np.inf
    for rounds in range(1, ROUNDS + 1):
        best, at = _polished(curve, omega, best, at, high)
        level = best - RESOLUTION * scale
        points = _with_middles(crossings(level), band)
        if not len(points):
            return Lowest(best, at, rounds, True)
        values = curve(points)
        if float(values.min()) >= level:
            return Lowest(best, at, rounds, True)
        best, at = float(values.min()), float(points[values.argmin()])
        omega = np.unique(np.concatenate([omega, points]))
    return Lowest(best, at, ROUNDS, False)


def intervals_below(
    curve: Curve, crossings: Crossings, level: float, known: Array, *, band: Interval = EVERYWHERE
) -> tuple[Interval, ...]:
    """The intervals in which a curve lies below a level, ends exact. Assumes that it ends above it at infinity.

    known : frequencies that are looked at beside those between the crossings
    """
    low, high = band
    points = np.concatenate([_with_middles(crossings(level), band), known[(known > low) & (known < high)]])
    omega = np.unique(np.concatenate([points, _ends(band)]))
    below = list(curve(omega) < level)
    places = omega.tolist()
    while below[-1] and np.isinf(high) and len(places) < len(omega) + STEPS:
        places.append(FARTHER * places[-1])
        below.append(bool(curve(np.array(places[-1:]))[0] < level))
    found: list[Interval] = []
    begin = low if below[0] else None
    for left, right, was, now in zip(places, places[1:], below, below[1:], strict=False):
        if was == now:
            continue
        end = _root(curve, level, left, right)
        if now:
            begin = end
        else:
            found.append((low if begin is None else begin, end))
            begin = None
    return tuple(found) if begin is None else (*found, (begin, high))


def _ends(band: Interval) -> list[float]:
    return [end for end in band if np.isfinite(end)]


def _root(curve: Curve, level: float, left: float, right: float) -> float:
    """Where the curve meets the level between two neighbours on either side of it; by ratios, as ends lie far apart."""

    def place(share: float) -> float:
        return left * (right / left) ** share if left > 0.0 else share * right

    def gap(share: float) -> float:
        return float(curve(np.array([place(share)]))[0]) - level

    ends = gap(0.0), gap(1.0)
    if ends[0] * ends[1] >= 0.0:  # one of them is the crossing, and rounding has decided its side
        return left if abs(ends[0]) <= abs(ends[1]) else right
    return place(float(brentq(gap, 0.0, 1.0, xtol=1e-15, rtol=1e-14)))


def _with_middles(crossings: Array, band: Interval) -> Array:
    """The candidates inside a band, and a point between each two, before the first and after the last."""
    low, high = band
    inside = crossings[(crossings > low) & (crossings < high)]
    if not len(inside):
        return inside
    ends = np.concatenate([[low], inside, [high if np.isfinite(high) else 2.0 * inside[-1]]])
    return np.unique(np.concatenate([inside, 0.5 * (ends[1:] + ends[:-1])]))


def _polished(curve: Curve, omega: Array, best: float, at: float, high: float) -> tuple[float, float]:
    """A minimum between the neighbours of the best point, in coordinates from that point, so that narrow ones count."""
    if not 0.0 < at < np.inf:
        return best, at
    lower, higher = omega[omega < at], omega[omega > at]
    left = float(lower[-1]) if len(lower) else at
    right = float(higher[0]) if len(higher) else min(2.0 * at, high)
    width = max(right - at, at - left)
    if width <= 0.0:
        return best, at
    found = minimize_scalar(
        lambda t: float(curve(np.array([at + width * t]))[0]),
        bounds=((left - at) / width, (right - at) / width),
        method="bounded",
        options={"xatol": 1e-10},
    )
    return (float(found.fun), float(at + width * found.x)) if found.fun < best else (best, at)
