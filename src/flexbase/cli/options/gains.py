"""Task gains that a command line gives in place of the project's."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from cyclopts import Group, Parameter

from flexbase.cli.options.common import option
from flexbase.cli.options.values import Vector, numbers
from flexbase.errors import InputError
from flexbase.model.task import Gains, make_gains
from flexbase.plant import Plant

LOOP = Group("Task-space loop", sort_key=20)


@Parameter(name="*", group=LOOP)
@dataclass(frozen=True)
class GainOptions:
    """Task gains in place of the project's."""

    stiffness: Annotated[Vector | None, option(numbers, "K,K", "task stiffness, one a row [N/m or N m/rad]")] = None
    damping: Annotated[Vector | None, option(numbers, "D,D", "task damping, one a row [N s/m or N m s/rad]")] = None

    def gains(self, plant: Plant) -> Gains | None:
        """The gains given, completed by the project's own; None where no option is given. Raises InputError."""
        if self.stiffness is None and self.damping is None:
            return None
        own, k = plant.arm.gains, plant.arm.k
        given = make_gains(self.stiffness or [0.0] * k, self.damping or [0.0] * k, k, where="--")
        if None not in (self.stiffness, self.damping):
            return given
        missing = "damping" if self.damping is None else "stiffness"
        if own is None:
            raise InputError(f"--{missing} is missing: {plant.name} has no [control] table to take it from. Give both.")
        return replace(given, **{missing: getattr(own, missing)})
