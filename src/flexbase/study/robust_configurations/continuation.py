"""A curve f(q) = 0 in a plane followed from a point on it: steps along the tangent, each corrected by Newton."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from flexbase.checks import Array

Equation = Callable[[Array], tuple[Array, Array, Array]]
"""Points (S, 2) to values (S,), gradients (S, 2), and a margin (S,): the curve is followed while that is positive."""

CORRECTIONS = 8
TURN = 0.3  # rad, of the tangent within a step: sharper bends take smaller steps
GROWTH = 1.5
SMALLEST = 1e-5  # of the largest step: where the curve has an end
MOST_POINTS = 100_000


class Trace(NamedTuple):
    """Points in order, shape (L, 2), and whether the last leads back to the first."""

    points: Array
    closed: bool


def follow(equation: Equation, start: Array, step: float, exact: float, periods: Array, window: Array) -> Trace:
    """The whole curve through a point, both ways.

    Assumes |f| <= exact at the start and a gradient there.

    step : largest distance between points; exact : largest |f|
    periods : of both coordinates, infinite where there is none; window : low and high of each, shape (2, 2), at which
        a coordinate without a period ends the curve
    """
    forward, closed = _one_way(equation, start, 1.0, step, exact, periods, window)
    if closed:
        return Trace(forward, True)
    backward, _ = _one_way(equation, start, -1.0, step, exact, periods, window)
    return Trace(np.concatenate([backward[:0:-1], forward]), False)


def _one_way(
    equation: Equation, start: Array, way: float, step: float, exact: float, periods: Array, window: Array
) -> tuple[Array, bool]:
    points, size = [start], step
    tangent = way * _tangent(equation, start)
    while len(points) < MOST_POINTS and size >= SMALLEST * step:
        found = _corrected(equation, points[-1] + size * tangent, exact)
        ahead = None if found is None else _tangent(equation, found)
        if found is None or ahead is None or not _smooth(points[-1], found, tangent, ahead, size):
            size *= 0.5
            continue
        low, high = window
        if ((found < low) | (found > high))[~np.isfinite(periods)].any():
            size *= 0.5  # up to the edge
            continue
        tangent = ahead if ahead @ tangent > 0.0 else -ahead
        points.append(found)
        rest = whole_turns_off(start - found, periods)
        if len(points) > 3 and np.linalg.norm(rest) < size and rest @ tangent >= 0.0 and (found != start).any():
            return np.array(points), True
        size = min(step, GROWTH * size)
    return np.array(points), False


def _tangent(equation: Equation, point: Array) -> Array:
    slope = equation(point[None])[1][0]
    return np.array([-slope[1], slope[0]]) / max(float(np.linalg.norm(slope)), 1e-300)


def _corrected(equation: Equation, guess: Array, exact: float) -> Array | None:
    """The curve's point nearest to a guess, or None where Newton does not arrive or the margin is lost."""
    point = guess
    for _ in range(CORRECTIONS):
        value, slope, margin = (part[0] for part in equation(point[None]))
        if not (np.isfinite(slope).all() and margin > 0.0):
            return None
        if abs(value) <= 0.01 * exact:
            return point
        point = point - value * slope / max(float(slope @ slope), 1e-300)
    value, _, margin = (part[0] for part in equation(point[None]))
    return point if abs(value) <= exact and margin > 0.0 else None


def _smooth(old: Array, new: Array, before: Array, after: Array, size: float) -> bool:
    """Whether a step went on along the curve, not across to another one."""
    gap = new - old
    length = float(np.linalg.norm(gap))
    bend = min(1.0, abs(float(before @ after)))
    return bool(0.5 * size < length < 1.5 * size and gap @ before > 0.9 * length and bend > np.cos(TURN))


def whole_turns_off(gap: Array, periods: Array) -> Array:
    """A difference without the whole periods in it."""
    finite = np.where(np.isfinite(periods), periods, 1.0)
    return np.asarray(gap - np.where(np.isfinite(periods), np.round(gap / finite) * finite, 0.0))


def near_polyline(rows: Array, line: Array, distance: float, periods: Array) -> np.ndarray:
    """Which rows (S, 2) lie within a distance of a polyline (L, 2), modulo the periods, shape (S,)."""
    near = np.zeros(len(rows), dtype=bool)
    spans = np.diff(line, axis=0)
    squares = np.maximum((spans**2).sum(axis=1), 1e-300)
    for i, row in enumerate(rows):
        offset = whole_turns_off(row - line[:-1], periods)
        share = np.clip((offset * spans).sum(axis=1) / squares, 0.0, 1.0)
        near[i] = ((offset - share[:, None] * spans) ** 2).sum(axis=1).min() <= distance**2
    return near
