"""The paper's arm, and the one configuration for which it designs a compensator.  [U03 Table I, Fig. 5]"""

from __future__ import annotations

from dataclasses import dataclass

from flexbase.plant import Plant, Pose, load

DESIGN_TIP = (0.33, -0.25)  # m, where the tip works
START_TIP = (0.33, 0.25)  # m, where the move of Fig. 9 begins
TARGET_FREQUENCY = 346.8  # rad/s, the asked omega_1


@dataclass(frozen=True, eq=False)
class Example:
    """The bundled arm `ueda2003` with its tip at `DESIGN_TIP`."""

    plant: Plant
    pose: Pose


def example() -> Example:
    """Load the paper's arm and bring its tip to the work point, 0 < q3 < pi."""
    plant = load("ueda2003")
    return Example(plant, plant.at_tip(DESIGN_TIP))
