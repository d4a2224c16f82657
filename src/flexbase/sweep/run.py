"""Sweep a plant over two axes: the maps of Fig. 6 and 8, and of any other measure."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence

import numpy as np

from flexbase.checks import choose
from flexbase.errors import FlexbaseWarning, InputError
from flexbase.linear.linearise import HasGain
from flexbase.measures import MEASURES
from flexbase.model.base import Base
from flexbase.plant import Plant
from flexbase.sweep.chart import UNREACHABLE, Chart
from flexbase.sweep.evaluate import evaluate
from flexbase.sweep.grid import Grid, joint_grid, tip_grid

BLOCK = 16384  # configurations evaluated together: their intermediate rows stay in the cache
LARGEST = 4_000_000  # cells


def sweep(
    plant: Plant,
    measures: Sequence[str] = ("robustness",),
    over: str = "tip",
    shape: tuple[int, int] = (400, 400),
    *,
    bounds: Sequence[float] | None = None,
    branch: str | None = None,
    joints: Sequence[str] = (),
    hold: Sequence[float] = (),
    compensator: HasGain | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Chart:
    """Measures over the tip's plane or over two arm joints, the base at its equilibrium.

    Modes are those of `real_modes`: exact for one base joint and for proportional damping.

    over : "tip", the first two task rows; or "joints", two arm joints (`joints` names them; if left out, the elbow and
        the one before)
    bounds : low, high, low, high of the two axes; the arm's reach, or a full turn, if left out
    hold : over tip, the task rows after the second; over joints, all n arm joints
    progress : called with the cells done and all cells
    Raises InputError. A cell that cannot be judged gets a status instead of values.
    """
    measures = [measures] if isinstance(measures, str) else measures
    chosen = [choose("measure", name, MEASURES) for name in measures]
    if not isinstance(shape, Sequence) or len(shape) != 2 or min(shape) < 2 or shape[0] * shape[1] > LARGEST:
        raise InputError(f"shape: {shape} is not two counts from 2 up with at most {LARGEST} cells.")
    arm = plant.arm
    if arm.has_gravity:
        warnings.warn(
            f"map: {plant.name} has gravity; its sag and stiffness are left out.", FlexbaseWarning, stacklevel=2
        )
    if any(one.per_mode for one in chosen) and not _proportional(arm.base):
        warnings.warn(
            f"map: the damping of {plant.name} couples the modes; a map shows those of the undamped base.",
            FlexbaseWarning,
            stacklevel=2,
        )
    for one in chosen:
        if missing := one.needs(arm.m, arm.n, arm.k):
            raise InputError(
                f"measure {one.name}: {missing} needed, {plant.name} has {arm.m} base joints, {arm.n} arm joints and "
                f"{arm.k} task rows."
            )
    lines = [MEASURES[one.zero_line] for one in chosen if one.zero_line]
    lines = [line for line in lines if line not in chosen and not line.needs(arm.m, arm.n, arm.k)]
    grid = _grid(plant, over, shape, bounds, branch, joints, hold)
    E = None if compensator is None else _gain(plant, compensator)
    total = len(grid.reached)
    status = np.full(total, UNREACHABLE, dtype=np.int8)
    values = {one.name: np.full((total, arm.m) if one.per_mode else total, np.nan) for one in chosen + lines}
    cells = np.flatnonzero(grid.reached)
    for begin in range(0, len(cells), BLOCK):
        block = cells[begin : begin + BLOCK]
        found = evaluate(arm, grid.joints[block], chosen + lines, E)
        status[block] = found.status
        for name, column in found.values.items():
            values[name][block] = column
        progress(int(block[-1]) + 1, total)
    rows, columns = len(grid.axes[1].values), len(grid.axes[0].values)
    folded = {name: column.reshape(rows, columns, *column.shape[1:]) for name, column in values.items()}
    shown = {one.name: folded[one.name] for one in chosen}
    zero_lines = {one.name: folded[one.zero_line] for one in chosen if one.zero_line in folded}
    return Chart(plant, grid.axes, shown, status.reshape(rows, columns), E is not None, zero_lines)


def _grid(
    plant: Plant,
    over: str,
    shape: tuple[int, int],
    bounds: Sequence[float] | None,
    branch: str | None,
    joints: Sequence[str],
    hold: Sequence[float],
) -> Grid:
    if over == "tip":
        return tip_grid(plant, shape, bounds, hold, branch)
    if over == "joints":
        return joint_grid(plant, shape, bounds, joints, hold)
    raise InputError(f'over: "{over}" is unknown. Give "tip" or "joints".')


def _proportional(base: Base) -> bool:
    """Whether mode shapes are real in every configuration: no damping, one joint, or damping like the stiffness."""
    D, K = base.damping, base.stiffness
    if base.m <= 1 or not D.any():
        return True
    ratio = np.trace(D) / np.trace(K)
    return bool(np.abs(D - ratio * K).max() <= 1e-12 * np.abs(D).max())


def _gain(plant: Plant, compensator: HasGain) -> np.ndarray:
    E = np.asarray(compensator.E)
    if E.shape != (plant.arm.n, plant.arm.n):
        raise InputError(f"compensator: E has shape {E.shape}, but {plant.name} has {plant.arm.n} arm joints.")
    return E
