"""The table of measures: one decorator line a measure."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from flexbase.linear.reduced import RealMode, Reduced
from flexbase.trace.algebra import Matrix, Scalar


class Configuration(NamedTuple):
    """What a measure may read of one configuration (or a batch of them).

    M, J : inertia (N x N) and task Jacobian (k x N); m : base joints, which come first
    """

    M: Matrix
    J: Matrix
    m: int
    reduced: Reduced
    modes: tuple[RealMode, ...]


Needs = Callable[[int, int, int], str | None]


def _nothing(m: int, n: int, k: int) -> None:
    """What most measures need: any arm will do."""


class Measure(NamedTuple):
    """A registered measure.

    per_mode : whether it reads one `RealMode` and has a value for each, or reads a `Configuration`
    zero_is : what its zero means, or None where zero means nothing
    zero_line : another measure that changes its sign, near 0, where this one only touches zero
    needs : of m, n and k (base joints, arm joints, task rows), what is missing for this measure, or None
    """

    name: str
    unit: str
    purpose: str
    per_mode: bool
    zero_is: str | None
    zero_line: str | None
    needs: Needs
    run: Callable[[Any], Scalar]


MEASURES: dict[str, Measure] = {}


def measure(
    name: str,
    *,
    unit: str,
    purpose: str,
    per_mode: bool = False,
    zero_is: str | None = None,
    zero_line: str | None = None,
    needs: Needs = _nothing,
) -> Callable[[Callable[[Any], Scalar]], Callable[[Any], Scalar]]:
    """Register a generic formula under a name."""

    def register(run: Callable[[Any], Scalar]) -> Callable[[Any], Scalar]:
        MEASURES[name] = Measure(name, unit, purpose, per_mode, zero_is, zero_line, needs, run)
        return run

    return register
