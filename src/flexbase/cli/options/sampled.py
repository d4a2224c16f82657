"""`flexbase simulate --sampled`: the move by a controller as hardware would run it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from cyclopts import Group, Parameter

from flexbase.cli.options.common import option
from flexbase.cli.options.from_request import from_methods, options_given
from flexbase.cli.options.move import as_sampled
from flexbase.cli.options.sensing import SensingOptions
from flexbase.cli.options.values import Vector, numbers
from flexbase.errors import InputError
from flexbase.model.loop import Loop
from flexbase.plant import Pose
from flexbase.simulation import Move, Push, SampledRun, simulate_sampled
from flexbase.synthesis import HARDWARE_METHODS
from flexbase.synthesis.make import make_controller

PUSH = 0.02  # s
SAMPLED = Group("Sampled", sort_key=15)


@from_methods(SAMPLED, HARDWARE_METHODS)
@dataclass(frozen=True)
class SampledOptions:
    """The loop as it runs, by the project's [sensing] table or 1 kHz with one sample of delay."""

    sampled: Annotated[bool, Parameter(help="run a sampled controller: held torques, delays, counts, noise")] = False
    method: Annotated[str | None, Parameter(metavar="NAME", help=f"of controller: {', '.join(HARDWARE_METHODS)}")] = (
        None
    )
    disturb: Annotated[
        Vector | None, option(numbers, "F,F", "force on the tool for 20 ms, midway in settling [N, N m]")
    ] = None

    def asked(self, senses: SensingOptions) -> bool:
        """Whether the loop is sampled. Raises InputError for options that mean nothing without it."""
        given = [
            name for name, value in {**vars(self), **vars(senses)}.items() if not (value is None or value is False)
        ]
        if given and not self.sampled:
            raise InputError(f"--{given[0].replace('_', '-')}: says how a sampled loop runs. Give --sampled with it.")
        return self.sampled

    def run(self, start: Pose, goal: Pose, senses: SensingOptions, loop: Loop, move: Move) -> SampledRun:
        """The move, by the method, else by task PD with the compensator, if any. Raises InputError, Infeasible."""
        times = as_sampled(move)
        push = None if self.disturb is None else Push(self.disturb, 0.5 * (times.switch + times.end), PUSH)
        if loop.compensator is not None and self.method is not None:
            raise InputError("--method and --compensator are both given. Give one of them.")
        meant = replace(loop, sensing=senses.sensing(goal.plant))
        controller = make_controller(goal, self.method, meant, **options_given(self))
        return simulate_sampled(controller, start, push=push, move=times)
