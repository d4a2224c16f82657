"""`flexbase simulate --sampled`: the move by a controller as hardware would run it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from cyclopts import Group, Parameter

from flexbase.cli.options.common import option
from flexbase.cli.options.sensing import SensingOptions
from flexbase.cli.options.words import Vector, numbers
from flexbase.control.compensator import Compensator
from flexbase.errors import InputError
from flexbase.model.loop import Loop, loop_on
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.sampled.controller import SampledController, pd_with_gain
from flexbase.simulation.hardware.result import Push, SampledRun
from flexbase.simulation.hardware.run import simulate_sampled
from flexbase.synthesis import HARDWARE_METHODS, controller_for

PUSH = 0.02  # s
SAMPLED = Group("Sampled", sort_key=15)


@Parameter(name="*", group=SAMPLED)
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
        words = {"method": self.method, "disturb": self.disturb, **vars(senses)}
        given = [name for name, value in words.items() if value is not None]
        if given and not self.sampled:
            raise InputError(f"--{given[0].replace('_', '-')}: says how a sampled loop runs. Give --sampled with it.")
        return self.sampled

    def controller(
        self, goal: Pose, senses: SensingOptions, gains: Gains | None, law: Compensator | None
    ) -> SampledController:
        """By the method, else task PD with the compensator, if any. Raises InputError, Infeasible."""
        sensing, used = senses.sensing(goal.plant), gains or goal.arm.gains
        if law is None:
            return controller_for(goal, self.method or "none", sensing, used)
        if self.method is not None:
            raise InputError("--method and --compensator are both given. Give one of them.")
        loop = loop_on(goal.arm, Loop(law, used, sensing))
        return pd_with_gain(goal, loop.sensing, loop.gains, loop.E, "compensator")

    def run(self, controller: SampledController, start: Pose, **times: Any) -> SampledRun:
        """The move. Raises InputError, MissingExtra."""
        middle = 0.5 * (times["switch"] + times["end"])
        push = None if self.disturb is None else Push(self.disturb, middle, PUSH)
        return simulate_sampled(controller, start, push=push, **times)
