"""The physics that can stand behind a run: the same laws drive any of them, in continuous time and in samples."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

from flexbase.checks import Array
from flexbase.dynamics.kinematics import Frames
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose
from flexbase.simulation.plants.builtin import accelerations
from flexbase.simulation.plants.builtin_held import BuiltinHeld
from flexbase.simulation.plants.mujoco_held import MujocoHeld
from flexbase.simulation.plants.mujoco_plant import mujoco_plant
from flexbase.simulation.plants.physics import Physics

Accelerations = Callable[[Frames, Array, Array, Array, Array | None], Array]


class Engine(NamedTuple):
    """One physics. Raises MissingExtra, InputError where it cannot answer.

    accelerations : of a goal -> q'' of a state and a torque, for an integrator of ours
    held : of goals, starts (runs, N) and sensing -> runs that move by themselves under held torques
    """

    accelerations: Callable[[Pose], Accelerations]
    held: Callable[[Sequence[Pose], Array, Sensing], Physics]


def mujoco(goal: Pose) -> Accelerations:
    """MuJoCo's inertia and forces, as an independent witness."""
    return mujoco_plant(goal).accelerations


ENGINES = {
    "builtin": Engine(lambda goal: partial(accelerations, goal), BuiltinHeld),
    "mujoco": Engine(mujoco, MujocoHeld),
}
