"""The physics that can stand behind a run: the same laws and the same integrator drive any of them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from flexbase.checks import Array
from flexbase.dynamics.kinematics import Frames
from flexbase.plant import Pose
from flexbase.simulation.plants.builtin import accelerations
from flexbase.simulation.plants.mujoco_plant import mujoco_plant

Accelerations = Callable[[Frames, Array, Array, Array, Array | None], Array]


def builtin(goal: Pose) -> Accelerations:
    """Our own dynamics."""
    return partial(accelerations, goal)


def mujoco(goal: Pose) -> Accelerations:
    """MuJoCo, as an independent witness. Raises MissingExtra, InputError."""
    return mujoco_plant(goal).accelerations


ENGINES: dict[str, Callable[[Pose], Accelerations]] = {"builtin": builtin, "mujoco": mujoco}
