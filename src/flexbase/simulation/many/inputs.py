"""What differs between many runs, checked: their starts and their parameters."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexbase.checks import FARTHEST, Array, check_within, choose, finite_array
from flexbase.dynamics.statics import static_base
from flexbase.dynamics.variation import Parameter, parameters_of
from flexbase.errors import InputError
from flexbase.plant import Plant, Pose
from flexbase.simulation.ends import end_on

PROBES = 8  # evenly spaced runs that stand for all
OF_LOOP = {
    "task_stiffness": Parameter("1", "factor on the stiffness of the task-space law", 1.0, 0.0),
    "task_damping": Parameter("1", "factor on the damping of the task-space law", 1.0, 0.0),
    "compensation": Parameter("1", "factor on the compensator's gain E", 1.0, -np.inf),
}


def inputs(plant: Plant, starts: Pose | ArrayLike, vary: Mapping[str, ArrayLike]) -> tuple[Array, dict[str, Array]]:
    """Arm joints (runs, n), and the varied values (runs,) of every run. Raises InputError."""
    n = plant.arm.n
    joints = end_on(plant, starts, None).joints if isinstance(starts, Pose) else finite_array("starts", starts)
    if joints.shape[-1:] != (n,) or joints.ndim > 2:
        raise InputError(f"starts: shape {joints.shape}; {n} arm joints are needed for each run, shape (runs, {n}).")
    check_within("starts", joints, FARTHEST, "rad or m")
    varied = _varied(plant, vary)
    counts = {"starts": joints.shape[0]} if joints.ndim == 2 else {}
    counts |= {name: values.size for name, values in varied.items() if values.ndim == 1}
    if len(set(counts.values())) > 1:
        given = ", ".join(f"{count} of {name}" for name, count in counts.items())
        raise InputError(f"runs: {given}. Give as many of each.")
    runs = next(iter(counts.values()), 1)
    if runs == 0:
        raise InputError("runs: there are none. Give at least one start.")
    everywhere = {name: np.broadcast_to(values, (runs,)) for name, values in varied.items()}
    return np.broadcast_to(joints, (runs, n)), everywhere


def _varied(plant: Plant, vary: Mapping[str, ArrayLike]) -> dict[str, Array]:
    known = {**parameters_of(plant.arm), **OF_LOOP}
    varied = {}
    for name, values in vary.items():
        parameter = choose("parameter", name, known)
        varied[name] = array = finite_array(name, values)
        if array.ndim > 1:
            raise InputError(f"{name}: shape {array.shape}; one value for each run is needed, shape (runs,).")
        if array.size and array.min() < parameter.least:
            raise InputError(f"{name}: {array.min():g} {parameter.unit} is below {parameter.least:g}. Give more.")
    return varied


def rests(plant: Plant, joints: Array) -> Array:
    """Where the base rests at each start, shape (runs, m)."""
    if not plant.arm.has_gravity:
        return np.tile(plant.arm.base.equilibrium, (len(joints), 1))
    different, which = np.unique(joints, axis=0, return_inverse=True)
    return np.array([static_base(plant.arm, one, plant.arm.base.equilibrium) for one in different])[which.ravel()]


def probes(varied: Mapping[str, Array], runs: int) -> NDArray[np.intp]:
    """A few runs that stand for all: evenly spaced ones, and the extremes of what varies."""
    extremes = [int(find(values)) for values in varied.values() for find in (np.argmin, np.argmax)]
    return np.unique([*np.linspace(0, runs - 1, min(runs, PROBES)).astype(int), *extremes])
