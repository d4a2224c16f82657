"""Robust arm configurations of an arm with two task rows, as curves over two of its joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.model.loop import Asked
from flexbase.plant import Plant
from flexbase.sheets.numbers import number
from flexbase.sheets.plain import Plain
from flexbase.sheets.sheet import Column, Sheet, facts, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.study.robust_configurations.continuation import Equation, follow, near_polyline
from flexbase.study.robust_configurations.misalignment import TITLE, Misalignment, make_misalignment, tips_of
from flexbase.sweeps.answers.tables import write_rows
from flexbase.sweeps.cells.grids import joint_box

CELLS = 360  # along each joint: a curve is found if it is farther than this from the next one
STEPS = 12  # of Newton; the start is within a cell, and each step squares the error
COVERED = 0.1  # of a cell: a point so near to a curve lies on it
EXACT = 1e-10  # sine of the angle between a and b


@dataclass(frozen=True, eq=False)
class RobustCurve(Plain):
    """One curve on which a mode is positive real.

    mode : from 1, slowest first
    joints : arm joints along the curve, shape (L, n), revolute ones continuous rather than within a turn
    tip : the resting tip there, shape (L, k)
    closed : whether the last point leads back to the first
    """

    mode: int
    joints: Array
    tip: Array
    closed: bool

    document: ClassVar = ("mode", "closed", "length", "joints", "tip")

    def row(self) -> tuple[str, ...]:
        """The curve in a line: mode, kind, points, length."""
        return str(self.mode), "closed" if self.closed else "open", str(len(self.joints)), number(self.length, 6)

    @property
    def length(self) -> float:
        """Arc length over the joints [rad, m]."""
        return float(np.linalg.norm(np.diff(self.joints, axis=0), axis=1).sum())


@dataclass(frozen=True, eq=False)
class RobustCurves(Told):
    """All robust arm configurations over two joints. Made by `robust_curves`.

    axes : names of the two joints; residual : largest |sin(a, b)| on any curve
    """

    plant: Plant
    axes: tuple[str, str]
    curves: tuple[RobustCurve, ...]
    residual: float
    compensated: bool

    document: ClassVar = ("robot=plant.name", "axes", "compensated", "residual", "curves")

    def save_csv(self, path: str | Path) -> None:
        """A line a point, curve after curve: number of the curve, mode, joints, tip. Raises InputError."""
        arm = self.plant.arm
        header = ["curve", "mode", *arm.joint_names, *arm.task.rows]
        rows = [
            [number, one.mode, *joints, *tip]
            for number, one in enumerate(self.curves, start=1)
            for joints, tip in zip(one.joints.tolist(), one.tip.tolist(), strict=True)
        ]
        write_rows(path, header, rows)

    def sheet(self) -> Sheet:
        """A row a curve."""
        return make_sheet(
            self.plant.name,
            TITLE,
            facts(("over", ", ".join(self.axes)), ("largest |sin(a, b)|", number(self.residual, 2))),
            table(
                [words("curve"), Column("mode"), words("kind"), Column("points"), Column("length")],
                ((str(i), *one.row()) for i, one in enumerate(self.curves, start=1)),
            ),
        )


def robust_curves(
    plant: Plant,
    axes: Sequence[str] = (),
    *,
    hold: Sequence[float] = (),
    bounds: Sequence[float] | None = None,
    cells: int = CELLS,
    loop: Asked = None,
) -> RobustCurves:
    """Curves over two arm joints on which a mode is positive real: the zeros of `turn`.  [theory §4]

    Assumes two task rows. Sign changes of sin(turn) on a grid give points, which Newton steps with exact derivatives
    bring onto the curves, to 1e-10; from these each curve is followed both ways, in steps of at most a cell, until it
    closes or ends. It ends at the window, where that is no full turn, and where the mode is no longer driven or no
    longer moves the tip (a or b vanishes): beyond, a and b are opposed. Modes of several base joints are numbered by
    frequency; where two of them meet, a curve ends too. On a curve the arm itself may be singular.

    axes, hold, bounds : as in `sweep` over joints
    cells : of the grid, along each joint; a loop smaller than a cell is missed
    Raises InputError, MissingExtra (extra `fast`).
    """
    from contourpy import contour_generator  # comes with matplotlib

    equations = make_misalignment(plant, loop)
    arm = plant.arm
    if arm.k != 2:
        raise InputError(
            f"robust curves: {plant.name} has {arm.k} task rows, and only two leave curves. Take robust_points."
        )
    names, _, varied, held, window = joint_box(plant, bounds, axes, hold)
    if len(varied) != 2:
        raise InputError(f"axes: {list(names)} are {len(varied)} joints, curves need two.")
    if not 8 <= cells <= 4000:
        raise InputError(f"cells: {cells} along each joint, but 8 to 4000 are looked at.")
    ticks = [np.linspace(window[2 * i], window[2 * i + 1], cells + 1) for i in range(2)]
    grid = np.tile(held, ((cells + 1) ** 2, 1))
    grid[:, varied] = np.stack(np.meshgrid(*ticks), axis=-1).reshape(-1, 2)
    sines = equations.sine(grid)[0]
    step = max(float(tick[1] - tick[0]) for tick in ticks)
    periods = np.array([_period(plant, joint, tick) for joint, tick in zip(varied, ticks, strict=True)])
    edges = np.array([[tick[0] for tick in ticks], [tick[-1] for tick in ticks]])
    place, rest = list(varied), np.array(held)
    curves, worst = [], 0.0
    for mode in range(arm.m):
        equation = _equation(equations, mode, rest, place)
        lines = contour_generator(ticks[0], ticks[1], sines[:, mode].reshape(cells + 1, cells + 1)).lines(0.0)
        seeds = _polished(equation, np.concatenate([np.zeros((0, 2)), *lines]), step)
        while len(seeds):
            found = follow(equation, seeds[0], step, EXACT, periods, edges)
            seeds = seeds[1:][~near_polyline(seeds[1:], found.points, COVERED * step, periods)]
            if len(found.points) < 2:
                continue
            worst = max(worst, float(np.abs(equation(found.points)[0]).max()))
            joints = np.tile(rest, (len(found.points), 1))
            joints[:, place] = found.points
            curves.append(RobustCurve(mode + 1, joints, tips_of(plant, joints), found.closed))
    curves.sort(key=lambda one: (one.mode, -one.length))
    return RobustCurves(plant, (names[0], names[1]), tuple(curves), worst, equations.E is not None)


def _equation(equations: Misalignment, mode: int, rest: Array, place: list[int]) -> Equation:
    """The sine of the angle from b to a over two joints; positive margin where they are not opposed."""

    def equation(points: Array) -> tuple[Array, Array, Array]:
        rows = np.tile(rest, (len(points), 1))
        rows[:, place] = points
        values, slopes = equations.sine(rows)
        apart = (equations(rows)[0][:, mode] ** 2).sum(axis=1)
        return values[:, mode], slopes[:, mode][:, place], 2.0 - apart

    return equation


def _polished(equation: Equation, points: Array, step: float) -> Array:
    """Those points that Newton steps along the slope bring onto the curve from less than a cell or two away."""
    found = points.copy()
    for _ in range(STEPS):
        values, slopes, _ = equation(found)
        move = -(values / np.maximum((slopes**2).sum(axis=1), 1e-300))[:, None] * slopes
        move *= np.minimum(1.0, step / np.maximum(np.abs(move).max(axis=1), 1e-300))[:, None]
        found = found + np.where((np.abs(values) > 0.01 * EXACT)[:, None], np.nan_to_num(move), 0.0)
    values, _, margins = equation(found)
    good = (np.abs(values) <= EXACT) & (margins > 0.0) & (np.linalg.norm(found - points, axis=1) <= 2.0 * step)
    return np.asarray(found[good])


def _period(plant: Plant, joint: int, ticks: Array) -> float:
    """A full turn where the window spans one, else none."""
    turns = plant.arm.joint_units[joint] == "rad"
    return 2.0 * np.pi if turns and abs(ticks[-1] - ticks[0] - 2.0 * np.pi) < 1e-9 else np.inf
