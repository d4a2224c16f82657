"""The loop that a command line means: compensator, task gains, and how it runs."""

from __future__ import annotations

from dataclasses import dataclass, replace

from cyclopts import Parameter

from flexbase.cli.options.common import CompensatorFile
from flexbase.cli.options.gains import GainOptions
from flexbase.cli.options.pose import compensator_of
from flexbase.cli.options.sensing import SensingOptions
from flexbase.model.loop import Loop
from flexbase.plant import Plant


@Parameter(name="*")
@dataclass(frozen=True)
class LoopOptions:
    """What a method makes a controller for."""

    gains: GainOptions = GainOptions()
    senses: SensingOptions = SensingOptions()

    def loop(self, plant: Plant) -> Loop:
        """Gains and sensing as far as they are given. Raises InputError."""
        sensing = self.senses.sensing(plant) if self.declared(plant) else None
        return Loop(gains=self.gains.gains(plant), sensing=sensing)

    def declared(self, plant: Plant) -> bool:
        """Whether project or command line say how the loop runs."""
        return self.senses.declared(plant)


@Parameter(name="*")
@dataclass(frozen=True)
class CompensatedLoopOptions(LoopOptions):
    """A loop that may have a compensator."""

    compensator: CompensatorFile = None

    def loop(self, plant: Plant) -> Loop:
        """Compensator, gains and sensing as far as they are given. Raises InputError."""
        return replace(super().loop(plant), compensator=compensator_of(plant, self.compensator))
