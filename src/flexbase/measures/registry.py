"""The table of measures: one decorator line a measure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from flexbase.linear.real_modes import real_modes
from flexbase.linear.reduced import RealMode, Reduced, reduce_arm
from flexbase.model.parts import Blocks, Parts
from flexbase.model.task import Gains
from flexbase.trace.algebra import Matrix, Scalar


@dataclass(frozen=True)
class Configuration:
    """What a measure may read of one configuration (or a batch of them, or a traced one).

    M, J : inertia (N x N) and task Jacobian (k x N); parts : which joints are the base
    stiffness, damping : of the base, Kp and Dp, m x m
    E : a compensator's gain, n x n, or None
    gains : of the task-space law, k x k each, or None
    """

    M: Matrix
    J: Matrix
    parts: Parts
    stiffness: Matrix
    damping: Matrix
    E: Matrix | None = None
    gains: Gains | None = None

    @cached_property
    def inertia(self) -> Blocks:
        """Mpp, Map and Mhat."""
        return self.parts.blocks(self.M)

    @cached_property
    def reduced(self) -> Reduced:
        """The reduced form under E."""
        return reduce_arm(self.M, self.J, self.parts, self.E)

    @cached_property
    def original(self) -> Reduced:
        """The reduced form without a compensator."""
        return self.reduced if self.E is None else reduce_arm(self.M, self.J, self.parts)

    @cached_property
    def modes(self) -> tuple[RealMode, ...]:
        """Modes with real shapes, slowest first, under E."""
        return real_modes(self.reduced, self.stiffness, self.damping)


Needs = Callable[[int, int, int], str | None]


def _nothing(m: int, n: int, k: int) -> None:
    """What most measures need: any arm will do."""


class Measure(NamedTuple):
    """A registered measure.

    per_mode : whether it reads one `RealMode` and has a value for each, or reads a `Configuration`
    all_modes : whether it reads the modes of that
    zero_is : what its zero means, or None where zero means nothing
    zero_line : another measure that changes its sign, near 0, where this one only touches zero
    needs : of m, n and k (base joints, arm joints, task rows), what is missing for this measure, or None
    slow : whether it needs eigenvalues of general matrices: NumPy alone, some thousand configurations a second
    feasible : where it has a value at all: a condition on the configuration; None: everywhere
    small_is_good : whether it is a cost: a search makes it small
    no_search : why a search cannot follow it, or None
    period : of an angle: it jumps by this, which is no change and no zero; None where it is no angle
    """

    name: str
    unit: str
    purpose: str
    run: Callable[[Any], Scalar]
    per_mode: bool = False
    all_modes: bool = False
    zero_is: str | None = None
    zero_line: str | None = None
    needs: Needs = _nothing
    slow: bool = False
    feasible: Callable[[Configuration], Scalar] | None = None
    small_is_good: bool = False
    no_search: str | None = None
    period: float | None = None

    @property
    def reads_modes(self) -> bool:
        """Whether it reads modes, one or all of them."""
        return self.per_mode or self.all_modes

    def __reduce__(self) -> tuple[Callable[[str], Measure], tuple[str]]:
        """Sent to another process by its name."""
        return _named, (self.name,)


MEASURES: dict[str, Measure] = {}


def _named(name: str) -> Measure:
    return MEASURES[name]


def measure(
    name: str, *, unit: str, purpose: str, **facts: Any
) -> Callable[[Callable[[Any], Scalar]], Callable[[Any], Scalar]]:
    """Register a generic formula under a name; facts : what else is true of it, fields of `Measure`."""

    def register(run: Callable[[Any], Scalar]) -> Callable[[Any], Scalar]:
        MEASURES[name] = Measure(name, unit, purpose, run, **facts)
        return run

    return register
