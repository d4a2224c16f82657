"""Measures that are angles: they jump by a period, and that is no change and no zero."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.measures import MEASURES


def short_way(name: str, change: Array) -> Array:
    """The change of a measure, of an angle by the shorter way round."""
    period = _period(name)
    return change if period is None else change - period * np.round(change / period)


def crossing(name: str, values: Array) -> Array:
    """A measure as far as a change of its sign is a zero; NaN near the jump of an angle."""
    period = _period(name)
    return values if period is None else np.where(np.abs(values) < period / 4.0, values, np.nan)


def _period(name: str) -> float | None:
    return MEASURES[name].period if name in MEASURES else None
