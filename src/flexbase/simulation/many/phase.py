"""The phases of many runs: which law acts when, and a kernel that repeats its step."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from flexbase.checks import Array
from flexbase.control.null_space import Law
from flexbase.errors import InputError
from flexbase.plant import Pose
from flexbase.simulation.laws import moving_law
from flexbase.simulation.many.step import Step
from flexbase.simulation.move import Moves
from flexbase.trace.algebra import Scalar, Vector
from flexbase.trace.kernel import Kernel, kernel_of

MOST_STEPS = 10_000_000  # of a phase


@dataclass(frozen=True)
class Tracking:
    """The move's law, of any start."""

    goal: Pose
    move: Moves

    def __call__(self, start: Vector, switch: Scalar) -> Law:
        return moving_law(self.goal, start, switch, self.move)


@dataclass(frozen=True)
class Always:
    """One law, whatever the start."""

    law: Law

    def __call__(self, start: Vector, switch: Scalar) -> Law:
        return self.law


@dataclass(frozen=True)
class Phase:
    """A step, repeated from `begin` to `finish` [s]; steps end where any of the equal `parts` does."""

    step: Step
    begin: float
    finish: float
    parts: int = 1

    @cached_property
    def kernel(self) -> Kernel:
        """The step as machine code. Raises MissingExtra."""
        return kernel_of(self.step, self.step.inputs, self.step.recipe, iterate=True)

    def length(self, longest: float) -> tuple[int, float]:
        """How many steps, and how long each. Raises InputError."""
        count = self.parts * int(np.ceil((self.finish - self.begin) / (self.parts * longest) - 1e-9))
        if count > MOST_STEPS:
            raise InputError(
                f"simulate_many: {count} steps of {longest:.3g} s, {MOST_STEPS} at most. Give a shorter run, lower "
                "gains or a larger tolerance."
            )
        return count, (self.finish - self.begin) / count

    def run(self, state: Array, constants: Array, longest: float, threads: int | None) -> Array:
        """The state of every run at the end. Steps are counted, and the tip error watched, from the begin."""
        count, step = self.length(longest)
        start, N = state.copy(), self.step.goal.arm.N
        start[2 * N : 2 * N + 3] = np.array([0.0, 0.0, -1.0])[:, None]  # taken, peak, outside
        clock = np.tile([[step], [self.begin], [self.finish]], state.shape[1])
        return self.kernel(np.vstack([start, clock, constants]), threads=threads, steps=count)
