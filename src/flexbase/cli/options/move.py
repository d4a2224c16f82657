"""How a simulated move is made, and on which plant."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Annotated, Any

from cyclopts import Group, Parameter

from flexbase.checks import choose
from flexbase.cli.options.common import option
from flexbase.cli.options.words import number
from flexbase.errors import InputError
from flexbase.simulation.plants.engines import ENGINES
from flexbase.simulation.run import SELF_MOTION

RUN = Group("Run", sort_key=12)


@Parameter(name="*", group=RUN)
@dataclass(frozen=True)
class RunOptions:
    """Times, laws and plant of a simulation, under the library's names."""

    trajectory: Annotated[str, Parameter(metavar="NAME", help="quintic (if left out) or trapezoidal")] = "quintic"
    switch: Annotated[float, option(number, "S", "task-space loop takes over [s], 0.1")] = 0.1
    end: Annotated[float, option(number, "S", "end of the run [s], 0.4")] = 0.4
    interval: Annotated[float, option(number, "S", "between samples [s], 0.0002")] = 2e-4
    compensate: Annotated[str, Parameter(metavar="WHEN", help="settle (from the switch on, if left out) or always")] = (
        "settle"
    )
    self_motion: Annotated[
        float, option(number, "W", "redundant arms: frequency of the null-space damping [rad/s], 20; 0: none")
    ] = SELF_MOTION
    engine: Annotated[
        str,
        Parameter(name="--plant", metavar="NAME", help="physics: builtin (if left out) or mujoco; engine= in Python"),
    ] = "builtin"

    def given(self) -> dict[str, Any]:
        """All of them, for `simulate`. Raises InputError."""
        choose("--plant", self.engine, ENGINES)
        return asdict(self)

    def times(self) -> dict[str, Any]:
        """Those of a sampled run. Raises InputError for options that it does not have."""
        here, plain = self.given(), asdict(RunOptions())
        for name in ("interval", "compensate", "self_motion"):
            if here[name] != plain[name]:
                raise InputError(f"--{name.replace('_', '-')}: a sampled run has none. Leave it out.")
        return {name: here[name] for name in ("switch", "end", "trajectory", "engine")}
