"""Fig. 9: move from (0.33, 0.25) to (0.33, -0.25) and settle, without and with the compensator."""

from __future__ import annotations

from dataclasses import dataclass

from flexbase.model.loop import HasGain
from flexbase.plant import Plant
from flexbase.simulation import Run, simulate
from flexbase.study.paper.example import DESIGN_TIP, START_TIP


@dataclass(frozen=True, eq=False)
class Settling:
    """The same move twice: joint tracking to 0.1 s, task-space PD to 0.4 s.  [U03 §IV B]

    Assumes a straight path in joint space under a quintic law: the paper does not give its path.
    """

    without: Run
    compensated: Run


def settling(plant: Plant, compensator: HasGain) -> Settling:
    """Simulate both runs with the project's task gains."""
    return Settling(simulate(plant, START_TIP, DESIGN_TIP), simulate(plant, START_TIP, DESIGN_TIP, compensator))
