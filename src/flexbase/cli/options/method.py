"""The design method and its options, passed on only where they are given."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from cyclopts import Group, Parameter

from flexbase.cli.options.common import option
from flexbase.cli.options.words import Vector, number, numbers, whole
from flexbase.compensators import METHODS
from flexbase.errors import InputError
from flexbase.plant import Plant

METHOD = Group("Method", sort_key=15)


@Parameter(name="*", group=METHOD)
@dataclass(frozen=True)
class MethodOptions:
    """How a compensator is designed."""

    method: Annotated[
        str | None, Parameter(metavar="NAME", help=f"{', '.join(METHODS)}; if left out, exact or convex, as fits")
    ] = None
    natural_frequency: Annotated[
        Vector | None,
        option(numbers, "W", "wanted [rad/s]; convex: a lower bound; task-priority: a list, slowest first"),
    ] = None
    highest_frequency: Annotated[float | None, option(number, "W", "convex: upper bound of all modes [rad/s]")] = None
    objective: Annotated[
        str | None,
        Parameter(
            metavar="NAME", help="exact: least-gain, least-radius; convex: aligned, mode-by-mode, least-misaligned"
        ),
    ] = None
    radius: Annotated[float | None, option(number, "G", "convex, bounded: bound on the algebraic-loop radius, 0.9")] = (
        None
    )
    margin: Annotated[float | None, option(number, "B", "convex: distance of beta from 0 and 1")] = None
    lag: Annotated[
        float | None,
        option(number, "S", "exact, convex: of the acceleration; may take half of the damping [s]"),
    ] = None
    lag_share: Annotated[float | None, option(number, "ETA", "with --lag: share it may take instead, 0.5")] = None
    derivatives: Annotated[str | None, Parameter(metavar="NAME", help="recursions: estimated or exact")] = None
    step: Annotated[float | None, option(number, "G", "recursions: share of the way in a step, up to 1")] = None
    iterations: Annotated[int | None, option(whole, "N", "recursions: number of steps")] = None
    seed: Annotated[int | None, option(whole, "N", "recursions, bounded: seed of what is random")] = None

    def given(self, plant: Plant) -> dict[str, Any]:
        """The options given, under the library's names. Raises InputError on a wrong count of frequencies."""
        frequency: Vector | float | None = self.natural_frequency
        if self.natural_frequency is not None:
            count, m = len(self.natural_frequency), plant.arm.m
            if count not in (1, m):
                raise InputError(f"--natural-frequency: {count} numbers given, {m} needed: one for each mode.")
            frequency = self.natural_frequency[0] if count == 1 else self.natural_frequency
        asked = {
            "natural_frequency": frequency,
            "highest_frequency": self.highest_frequency,
            "objective": self.objective,
            "margin": self.margin,
            "radius": self.radius,
            "lag": self.lag,
            "lag_share": self.lag_share,
            "derivatives": self.derivatives,
            "step": self.step,
            "iterations": self.iterations,
            "seed": self.seed,
        }
        return {name: value for name, value in asked.items() if value is not None}
