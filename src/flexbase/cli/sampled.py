"""`flexbase simulate --sampled`: the move by a controller as hardware would run it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

from cyclopts import Group, Parameter
from rich.console import RenderableType

from flexbase.cli.digits import number as shown
from flexbase.cli.options import option
from flexbase.cli.show import facts, title, verdict
from flexbase.cli.words import Vector, number, numbers
from flexbase.control.compensator import Compensator
from flexbase.control.sampled_controller import SampledController, pd_with_gain
from flexbase.design.hardware import controller_for
from flexbase.errors import InputError
from flexbase.model.sensing import TYPICAL, checked_sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.simulate.sampled import simulate_sampled
from flexbase.simulate.sampled_result import Push, SampledRun

PUSH = 0.02  # s
SAMPLED = Group("Sampled", sort_key=15)


@Parameter(name="*", group=SAMPLED)
@dataclass(frozen=True)
class SampledOptions:
    """The loop as it runs, by the project's [sensing] table or 1 kHz with one sample of delay."""

    sampled: Annotated[bool, Parameter(help="run a sampled controller: held torques, delays, counts, noise")] = False
    method: Annotated[str | None, Parameter(metavar="NAME", help="of controller; see flexbase recommend")] = None
    rate: Annotated[float | None, option(number, "HZ", "of the controller, in place of the project's")] = None
    disturb: Annotated[
        Vector | None, option(numbers, "F,F", "force on the tool for 20 ms, midway in settling [N, N m]")
    ] = None

    @property
    def asked(self) -> bool:
        """Whether the loop is sampled. Raises InputError for options that mean nothing without it."""
        given = [name for name in ("method", "rate", "disturb") if getattr(self, name) is not None]
        if given and not self.sampled:
            raise InputError(f"--{given[0]}: says how a sampled loop runs. Give --sampled with it.")
        return self.sampled

    def controller(self, goal: Pose, gains: Gains | None, law: Compensator | None) -> SampledController:
        """By the method, else the compensator, else task PD alone. Raises InputError, Infeasible."""
        declared = goal.arm.sensing or TYPICAL
        sensing = declared if self.rate is None else replace(declared, rate=self.rate)
        if law is None or self.method is not None:
            if law is not None:
                raise InputError("--method and --compensator are both given. Give one of them.")
            return controller_for(goal, self.method or "none", sensing, gains)
        used = gains or goal.arm.gains
        if used is None:
            raise InputError(f"{goal.plant.name}: no task gains. Give --stiffness and --damping.")
        return pd_with_gain(goal, checked_sensing(sensing, goal.arm.n), used, law.E, "compensator")

    def run(self, controller: SampledController, start: Pose, **times: Any) -> SampledRun:
        """The move. Raises InputError, MissingExtra."""
        middle = 0.5 * (times["switch"] + times["end"])
        push = None if self.disturb is None else Push(self.disturb, middle, PUSH)
        return simulate_sampled(controller, start, push=push, **times)


def tables(found: SampledRun) -> list[RenderableType]:
    """What was run, the linear verdict, and whether the tip settles."""
    time, size = found.settling_time_s, 1e3 * found.tolerance
    word = "stable" if found.predicted else "unstable"
    said = [
        ("linear verdict", f"{word}, spectral radius {found.spectral_radius:.5f} a sample"),
        (f"settling time after {found.judged_from:g} s", "none" if time is None else f"{shown(1e3 * time, 4)} ms"),
        ("largest tip error after the switch", f"{shown(1e3 * found.peak_error_m, 4)} mm (or mrad)"),
        ("peak torque", ", ".join(shown(torque, 4) for torque in found.peak_torque) + " N m (or N)"),
        ("samples saturated", f"{found.saturated_samples} of {len(found.t)}"),
    ]
    heading = f"{found.controller.name} at {found.controller.sensing.rate:g} Hz, plant {found.engine}"
    end = verdict(
        found.settled, f"Settles below {size:g} mm", f"Does not settle below {size:g} mm", found.stopped or ""
    )
    return [title(found.goal.plant.name, heading), facts(said), "", end]
