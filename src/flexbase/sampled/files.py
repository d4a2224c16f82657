"""Sampled controllers on disk: one JSON document, checked on reading."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from flexbase.cautions import caution
from flexbase.checks import Array, finite_array, positive_number
from flexbase.errors import InputError, read_document, writing
from flexbase.linear.discrete.system import Discrete
from flexbase.model.digest import model_digest
from flexbase.model.sensing import Sensing, checked_sensing
from flexbase.plant import Plant, check_plant
from flexbase.sampled.controller import SampledController

FORMAT = "flexbase controller 1"
MEND = "Give a file that `save_controller` wrote."


def save_controller(controller: SampledController, path: str | Path) -> None:
    """Write a controller as JSON: its state space with all digits, pose, sensing and notes. Raises InputError."""
    system = controller.system
    document = {
        "format": FORMAT,
        "model": model_digest(controller.pose.arm),
        **controller.to_dict(),
        "shapes": {part: list(getattr(system, part).shape) for part in "ABCD"},
    }
    with writing(path):
        Path(path).write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


def load_controller(path: str | Path, plant: Plant) -> SampledController:
    """Read a controller that `save_controller` wrote, on the robot that it was made for.

    Warns where the robot's numbers have changed since. Raises InputError, also for another robot.
    """
    check_plant(plant)
    document = read_document(path, "controller", FORMAT, MEND)
    try:
        return _read(path, document, plant)
    except (KeyError, TypeError, AttributeError) as fault:
        raise InputError(f"{path}: a controller whose entries are missing or unknown. {MEND}") from fault


def _read(path: str | Path, document: dict[str, Any], plant: Plant) -> SampledController:
    arm = plant.arm
    if document["robot"] != plant.name:
        raise InputError(f'{path}: made for "{document["robot"]}", not for "{plant.name}". Load that robot.')
    if document["model"] != model_digest(arm):
        caution(f"{path}: {plant.name} has other numbers than when this controller was made. Judge it again.")
    sensing = checked_sensing(Sensing(**_tuples(document["sensing"])), arm.n, f"{path}, sensing, ")
    A, B, C, D = (_matrix(path, part, document) for part in "ABCD")
    step = positive_number(f"{path}: step", document["step"], "s")
    if not np.isclose(step, sensing.step, rtol=1e-12, atol=0.0):
        raise InputError(f"{path}: step {step:g} s, but the sensing samples every {sensing.step:g} s. {MEND}")
    order = len(A)
    wanted = {
        "A": (order, order),
        "B": (order, arm.k + 2 * arm.n),
        "C": (arm.n, order),
        "D": (arm.n, arm.k + 2 * arm.n),
    }
    for name, matrix in zip("ABCD", (A, B, C, D), strict=True):
        if matrix.shape != wanted[name]:
            raise InputError(f"{path}: {name} has shape {matrix.shape}, but {plant.name} needs {wanted[name]}. {MEND}")
    joints = finite_array(f"{path}: q", document["q"])
    rest = finite_array(f"{path}: equilibrium", document["equilibrium"])
    if joints.shape != (arm.N,) or rest.shape != (arm.m,):
        raise InputError(f"{path}: {joints.size} joints, but {plant.name} has {arm.N}. {MEND}")
    pose = plant.at(arm.parts.whole(rest, arm.parts.arm(joints)))
    E = None if document["E"] is None else finite_array(f"{path}: E", document["E"])
    if E is not None and E.shape != (arm.n, arm.n):
        raise InputError(f"{path}: E has shape {E.shape}, but {plant.name} has {arm.n} arm joints. {MEND}")
    return SampledController(
        str(document["name"]), pose, sensing, Discrete(A, B, C, D, step), E, dict(document["notes"])
    )


def _matrix(path: str | Path, name: str, document: dict[str, Any]) -> Array:
    """A matrix of the state space; one without rows or columns keeps its shape."""
    shape = tuple(int(size) for size in document["shapes"][name])
    given = finite_array(f"{path}: {name}", document[name])
    if given.size != np.prod(shape):
        raise InputError(f"{path}: {name} has {given.size} entries, but its shape is {shape}. {MEND}")
    return np.asarray(given.reshape(shape))


def _tuples(table: dict[str, Any]) -> dict[str, Any]:
    return {name: tuple(value) if isinstance(value, list) else value for name, value in table.items()}
