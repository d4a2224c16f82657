"""Grids of configurations: over the tip, with inverse kinematics in every cell, or over two arm joints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array, check_length
from flexbase.dynamics.inverse_kinematics import arm_angles_of_many, elbow_of, reach
from flexbase.dynamics.two_joint_arm import two_joint_arm
from flexbase.errors import InputError, nearest_name
from flexbase.model.task import check_branch
from flexbase.plant import Plant
from flexbase.sweep.chart import Axis

BENT = 0.5  # rad or m, where joints outside a joint map stand: at zero many arms are stretched
MARGIN = 1.02  # half-width of the default window, over the arm's reach


class Grid(NamedTuple):
    """Cells of a map, row by row.

    joints : arm joints of each cell, shape (cells, n); reached : whether there are any, shape (cells,)
    """

    axes: tuple[Axis, Axis]
    joints: Array
    reached: NDArray[np.bool_]


def tip_grid(
    plant: Plant, shape: tuple[int, int], bounds: Sequence[float] | None, hold: Sequence[float], branch: str | None
) -> Grid:
    """A grid over the first two task rows; `hold` gives the others. Raises InputError."""
    task = plant.arm.task
    if task.k < 2:
        raise InputError(
            f"map over tip: {plant.name} has one task row, two are needed; a map over joints needs two arm joints."
        )
    window = _window(plant) if bounds is None else _checked_bounds(bounds)
    held = check_length(
        "hold",
        hold,
        task.k - 2,
        f"give hold, one for each task row after the second ({' '.join(task.rows[2:]) or 'none'})",
    )
    axes = tuple(Axis(task.rows[i], task.units[i], _ticks(window, i, shape)) for i in range(2))
    x, y = np.meshgrid(axes[0].values, axes[1].values)
    targets = np.column_stack([x.ravel(), y.ravel(), *(np.full(x.size, value) for value in held)])
    side = check_branch(branch or task.branch)
    joints, reached = arm_angles_of_many(plant.arm.mechanism, task, plant.arm.base.equilibrium, targets, side)
    return Grid((axes[0], axes[1]), joints, reached)


def joint_grid(
    plant: Plant, shape: tuple[int, int], bounds: Sequence[float] | None, joints: Sequence[str], hold: Sequence[float]
) -> Grid:
    """A grid over two arm joints; the others stand at `hold`, n values (`BENT` if empty). Raises InputError."""
    arm = plant.arm
    names = arm.mechanism.joint_names[arm.m :]
    if arm.n < 2:
        raise InputError(f"map over joints: {plant.name} has one arm joint, two are needed.")
    elbow = elbow_of(arm.n) or 1
    chosen = tuple(joints) or names[elbow - 1 : elbow + 1]
    if len(chosen) != 2 or chosen[0] == chosen[1]:
        raise InputError(f"map over joints: {list(chosen)} given, two different arm joints needed.")
    for name in chosen:
        if name not in names:
            raise InputError(f'map over joints: no arm joint "{name}". {nearest_name(name, names)}')
    places = [names.index(name) for name in chosen]
    kinds = [arm.mechanism.joint_types[arm.m + place] for place in places]
    spans = [np.pi if kind == "revolute" else reach(arm.mechanism) for kind in kinds]
    window = [-spans[0], spans[0], -spans[1], spans[1]] if bounds is None else _checked_bounds(bounds)
    units = ["rad" if kind == "revolute" else "m" for kind in kinds]
    axes = tuple(Axis(chosen[i], units[i], _ticks(window, i, shape)) for i in range(2))
    x, y = np.meshgrid(axes[0].values, axes[1].values)
    still = check_length("hold", hold, arm.n, "one for each arm joint") if len(hold) else np.full(arm.n, BENT)
    cells = np.tile(still, (x.size, 1))
    cells[:, places[0]], cells[:, places[1]] = x.ravel(), y.ravel()
    return Grid((axes[0], axes[1]), cells, np.ones(x.size, dtype=bool))


def _ticks(window: Sequence[float], axis: int, shape: tuple[int, int]) -> Array:
    return np.linspace(window[2 * axis], window[2 * axis + 1], shape[axis])


def _checked_bounds(bounds: Sequence[float]) -> list[float]:
    window = check_length("bounds", bounds, 4, "low, high of the first axis and of the second").tolist()
    if not (window[0] < window[1] and window[2] < window[3]):
        raise InputError(f"bounds: {window} are not low, high, low, high. Give each low below its high.")
    return list(window)


def _window(plant: Plant) -> list[float]:
    """A square around all that the tip can reach."""
    arm = plant.arm
    planar = two_joint_arm(arm.mechanism, arm.task, arm.base.equilibrium)
    centre = np.zeros(2) if planar is None else planar.shoulder
    radius = MARGIN * (reach(arm.mechanism) if planar is None else planar.upper + planar.fore)
    return [float(edge) for axis in centre for edge in (axis - radius, axis + radius)]
