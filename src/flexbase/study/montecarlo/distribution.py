"""What is known of a parameter that is not known exactly: distributions, by name or as text."""

from __future__ import annotations

import re
from dataclasses import dataclass, fields

import numpy as np
from scipy.special import ndtr, ndtri

from flexbase.checks import Array, choose
from flexbase.errors import InputError
from flexbase.sweeps.cells.parameters import Parameter

LARGEST = 1e5  # of a parameter, as in sweeps
WRITTEN = re.compile(r"\s*(\w+)\s*(?:\((?P<inside>[^()]*)\)|:(?P<after>[^()]*))\s*")


@dataclass(frozen=True)
class Uniform:
    """Equally likely everywhere between two ends."""

    low: float
    high: float

    def problem(self, least: float) -> str | None:
        """What is wrong for a parameter of at least `least`, or None."""
        if least <= self.low <= self.high <= LARGEST:
            return None
        return f"ends from {least:g} to {LARGEST:g} are needed, the low one first"

    def quantiles(self, unit: Array, least: float) -> Array:
        """Values below which lie these parts of all draws."""
        return np.asarray(self.low + (self.high - self.low) * unit)


@dataclass(frozen=True)
class Normal:
    """Gaussian about a mean, cut off below the least value that the parameter has (for factors and masses, 0)."""

    mean: float
    deviation: float

    def problem(self, least: float) -> str | None:
        """What is wrong for a parameter of at least `least`, or None."""
        if least <= self.mean <= LARGEST and 0.0 <= self.deviation <= LARGEST:
            return None
        return f"a mean from {least:g} to {LARGEST:g} and a standard deviation of at least 0 are needed"

    def quantiles(self, unit: Array, least: float) -> Array:
        """Values below which lie these parts of all draws."""
        if self.deviation == 0.0:
            return np.full(unit.shape, self.mean)
        cut = ndtr((least - self.mean) / self.deviation)
        return np.asarray(np.maximum(self.mean + self.deviation * ndtri(cut + (1.0 - cut) * unit), least))


@dataclass(frozen=True)
class Lognormal:
    """Its logarithm is Gaussian; `spread` is the logarithm's deviation, for small ones the relative deviation."""

    median: float
    spread: float

    def problem(self, least: float) -> str | None:
        """What is wrong for a parameter of at least `least`, or None."""
        if max(least, 0.0) <= self.median <= LARGEST and self.median > 0.0 and 0.0 <= self.spread <= 3.0:
            return None
        return f"a median above {max(least, 0.0):g} and a spread from 0 to 3 are needed"

    def quantiles(self, unit: Array, least: float) -> Array:
        """Values below which lie these parts of all draws."""
        if self.spread == 0.0:
            return np.full(unit.shape, self.median)
        cut = ndtr(np.log(least / self.median) / self.spread) if least > 0.0 else 0.0
        return np.asarray(self.median * np.exp(self.spread * ndtri(cut + (1.0 - cut) * unit)))


@dataclass(frozen=True)
class Fixed:
    """One value, in every draw."""

    value: float

    def problem(self, least: float) -> str | None:
        """What is wrong for a parameter of at least `least`, or None."""
        return None if least <= self.value <= LARGEST else f"a value from {least:g} to {LARGEST:g} is needed"

    def quantiles(self, unit: Array, least: float) -> Array:
        """The value, for each part of all draws."""
        return np.full(unit.shape, self.value)


Distribution = Uniform | Normal | Lognormal | Fixed
DISTRIBUTIONS = {kind.__name__.lower(): kind for kind in (Uniform, Normal, Lognormal, Fixed)}


def written(distribution: Distribution) -> str:
    """As it is given in text: `normal(1, 0.15)`."""
    numbers = ", ".join(f"{getattr(distribution, field.name):g}" for field in fields(distribution))
    return f"{type(distribution).__name__.lower()}({numbers})"


def read_distribution(name: str, given: object, parameter: Parameter) -> Distribution:
    """A parameter's distribution from text, `normal(1,0.15)` or `normal:1:0.15`, a number, or a distribution.

    Raises InputError with the parameter's name.
    """
    found = given if isinstance(given, Distribution) else _from_text(name, given)
    problem = found.problem(parameter.least)
    if problem is not None:
        raise InputError(f"vary: {name}={written(found)}: {problem}.")
    return found


def _from_text(name: str, given: object) -> Distribution:
    text = str(given)
    try:
        return Fixed(float(text))
    except ValueError:
        pass
    match = WRITTEN.fullmatch(text)
    if match is None:
        raise InputError(
            f'vary: {name}: "{text}" is no distribution. Give such as normal(1,0.15), uniform(0,3), lognormal(1,0.05) '
            "or fixed(1); in a shell also normal:1:0.15."
        )
    kind = choose(f"vary: {name}", match[1].lower(), DISTRIBUTIONS)
    inside = match["after"].split(":") if match["inside"] is None else match["inside"].split(",")
    names = [field.name for field in fields(kind)]
    try:
        numbers = [float(part) for part in inside]
    except ValueError:
        numbers = []
    if len(numbers) != len(names) or not np.all(np.isfinite(numbers)):
        raise InputError(
            f'vary: {name}: "{text}" does not give {" and ".join(names)}. '
            f"Write {match[1].lower()}({','.join(names)}) with finite numbers."
        )
    return kind(*numbers)
