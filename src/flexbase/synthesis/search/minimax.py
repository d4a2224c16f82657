"""Descent on a largest value of several: a linear programme a step, in a box that grows and shrinks."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

from flexbase.checks import Array

FIRST, WIDEST, NARROWEST = 0.2, 1.0, 2e-4  # half-widths of the box
ENOUGH = 1e-4  # promised decrease that is not worth a step


class Landscape(NamedTuple):
    """A sum of groups at x, each the largest of its pieces.

    value : what is descended on; groups : values (pieces,) and slopes (pieces, x) of each
    """

    value: float
    groups: tuple[tuple[Array, Array], ...]


class Found(NamedTuple):
    """Where the descent ended, its value, and how often the landscape was looked at."""

    x: Array
    value: float
    looks: int


def descend(look: Callable[[Array], Landscape], start: Array, most: int = 60) -> Found:
    """A local minimum, from `start`: sequential linear programming with a trust region.

    Each step minimises the sum over groups of max_i value_i + slope_i . d over a box |d| <= width; the box grows where
    the promise was kept and shrinks where it was not. Values never rise.
    """
    x, width = np.array(start, dtype=float), FIRST
    here, looks = look(x), 1
    while looks < most and width >= NARROWEST:
        step, promised = _step(here, width)
        if promised < ENOUGH:
            break
        there = look(x + step)
        looks += 1
        kept = (here.value - there.value) / promised
        if kept > 0.1:
            x, here = x + step, there
        width = min(WIDEST, 2.0 * width) if kept > 0.7 else width if kept > 0.25 else 0.35 * width
    return Found(x, here.value, looks)


def _step(here: Landscape, width: float) -> tuple[Array, float]:
    """The best step inside the box by the pieces' slopes, and the decrease that it promises."""
    size, count = here.groups[0][1].shape[1], len(here.groups)
    rows, bounds = [], []
    for group, (values, slopes) in enumerate(here.groups):
        level = np.zeros((len(values), count))
        level[:, group] = -1.0
        rows.append(np.hstack([slopes, level]))
        bounds.append(-values)
    cost = np.concatenate([np.zeros(size), np.ones(count)])
    box = np.concatenate([np.full(size, width), np.full(count, np.inf)])
    model = LinearConstraint(np.vstack(rows), ub=np.concatenate(bounds))
    solved = milp(cost, constraints=model, bounds=Bounds(-box, box))  # all continuous: less around it than in linprog
    if solved.x is None:
        return np.zeros(size), 0.0
    before = sum(float(values.max()) for values, _ in here.groups)
    return np.asarray(solved.x[:size]), before - float(solved.fun)
