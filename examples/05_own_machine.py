"""A machine of your own: a three-joint arm with a tool on a gantry that slides and twists (gantry.toml)."""

import warnings
from pathlib import Path

import flexbase as fb

plant = fb.load(Path(__file__).parent / "gantry.toml")
goal = plant.at_tip([0.6, 0.3, 0.3])  # x, y [m] and the tool's angle [rad]
before = fb.modes(goal)
print(before.summary())

# two base joints: the slowest mode first, each asked to rise by 2 per cent, so that rho stays below 1
targets = [1.02 * mode.frequency for mode in before.modes]
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always", fb.FlexbaseWarning)
    compensator = fb.design(goal, method="task-priority", natural_frequency=targets, iterations=300)
print(f"\n{compensator.summary()}")
for caution in caught:
    print(f"warning: {caution.message}")

start = plant.at_tip([0.5, 0.4, 0.3])
print()
for used in (None, compensator):
    run = fb.simulate(plant, start, goal, used, move=fb.Move(switch=0.15, end=0.4))
    print(run.summary())
