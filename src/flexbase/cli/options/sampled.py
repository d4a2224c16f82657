"""Which sampled controller a command line asks for, and what pushes the tool."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from cyclopts import Group, Parameter

from flexbase.cli.options.common import option
from flexbase.cli.options.from_request import from_methods
from flexbase.cli.options.values import Vector, numbers
from flexbase.simulation import Push, SampledMove
from flexbase.synthesis import HARDWARE_METHODS

PUSH = 0.02  # s
SAMPLED = Group("Controller", sort_key=15)


@from_methods(SAMPLED, HARDWARE_METHODS)
@dataclass(frozen=True)
class SampledOptions:
    """By a method, else task PD with the compensator, if any."""

    method: Annotated[str | None, Parameter(metavar="NAME", help=f"of controller: {', '.join(HARDWARE_METHODS)}")] = (
        None
    )
    disturb: Annotated[
        Vector | None, option(numbers, "F,F", "force on the tool for 20 ms, midway in settling [N, N m]")
    ] = None

    def push(self, move: SampledMove) -> Push | None:
        """The push that is asked for, midway between the switch and the end."""
        return None if self.disturb is None else Push(self.disturb, 0.5 * (move.switch + move.end), PUSH)
