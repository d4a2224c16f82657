"""What "the design holds" means: conditions on a configuration, by name or as bounds on any measure."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import choose
from flexbase.errors import InputError
from flexbase.measures import MEASURES
from flexbase.sweeps.engine.question import Block
from flexbase.sweeps.engine.status import INDEFINITE

TOLERANCE = 0.01  # of `robust`: cos(a, b) = 0.98, an angle of 11.5 degrees between a mode's two directions


@dataclass(frozen=True)
class Criterion:
    """A measure within bounds, in every mode where it has a value for each.

    measure : its name, or None for M - E positive definite, which every other criterion needs as well
    low, high : bounds in the measure's unit; they belong to the range unless `open`
    """

    name: str
    measure: str | None = None
    low: float = -np.inf
    high: float = np.inf
    open: bool = False

    def holds(self, block: Block) -> NDArray[np.bool_]:
        """For each configuration, shape (cells,). What has no value does not hold."""
        if self.measure is None:
            return np.asarray(block.status != INDEFINITE)
        values = block.values[self.measure]
        inside = (
            (values > self.low) & (values < self.high) if self.open else (values >= self.low) & (values <= self.high)
        )
        return np.asarray(inside.all(axis=1) if inside.ndim == 2 else inside)

    def __str__(self) -> str:
        """In words: `robust: shortage <= 0.01`, `frequency >= 300 rad/s`."""
        if self.measure is None:
            return f"{self.name}: M - E positive definite"
        unit = MEASURES[self.measure].unit
        unit = "" if unit == "1" else f" {unit}"
        less, more = ("<", ">") if self.open else ("<=", ">=")
        prefix = "" if self.name == self.measure else f"{self.name}: "
        if not np.isfinite(self.low):
            return f"{prefix}{self.measure} {less} {self.high:g}{unit}"
        if not np.isfinite(self.high):
            return f"{prefix}{self.measure} {more} {self.low:g}{unit}"
        return f"{prefix}{self.low:g} {less} {self.measure} {less} {self.high:g}{unit}"


CRITERIA = {
    "definite": Criterion("definite"),
    "robust": Criterion("robust", "shortage", high=TOLERANCE),
    "stable": Criterion("stable", "closed_loop_abscissa", high=0.0, open=True),
    "loop": Criterion("loop", "algebraic_loop_radius", high=1.0, open=True),
}
USUAL = ("definite", "robust")


def read_criterion(given: object) -> Criterion:
    """A criterion from text: `robust`, `robust=0.05` (another bound), or a measure's range, `frequency=300:400`.

    Either end of a range may be left out: `frequency=300:`. Raises InputError.
    """
    if isinstance(given, Criterion):
        if given.measure is not None:
            choose("criterion", given.measure, MEASURES)
        return given
    name, equals, bounds = (part.strip() for part in str(given).partition("="))
    if name in CRITERIA:
        known = CRITERIA[name]
        if not equals:
            return known
        if known.measure is None:
            raise InputError(f'criterion: "{given}" has a bound, but {known} has none. Give {name} alone.')
        return replace(known, high=_number(given, bounds))
    choose("criterion", name, {**CRITERIA, **MEASURES})
    ends = bounds.split(":")
    if len(ends) != 2 or not any(end.strip() for end in ends):
        raise InputError(f'criterion: "{given}" is not {name}=LOW:HIGH. Give such as {name}=1: or {name}=1:2.')
    low, high = (
        _number(given, end) if end.strip() else edge for end, edge in zip(ends, (-np.inf, np.inf), strict=True)
    )
    if not low <= high:
        raise InputError(f'criterion: "{given}" has its low end above its high end. Give them in order.')
    return Criterion(name, name, low, high)


def _number(given: object, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise InputError(f'criterion: "{given}": "{text}" is not a finite number.')
    return value
