"""Where to put the work, or the base: targets moved together until the arm can stand on all of them robustly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from flexbase.checks import Array, positive_number
from flexbase.errors import InputError, Unreachable
from flexbase.measures import Measure
from flexbase.model.loop import Asked
from flexbase.model.task import check_branch
from flexbase.plant import Plant
from flexbase.sheets.numbers import number
from flexbase.sheets.sheet import Column, Sheet, answer, facts, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.study.layout.placement import make_placement
from flexbase.study.layout.postures_on_targets import Standing, branches_of, stand
from flexbase.study.layout.search import best_place
from flexbase.study.layout.targets import Targets, make_targets
from flexbase.study.postures.epigraph import GOALS, WORST
from flexbase.study.postures.objective import Objective, make_objective
from flexbase.sweeps.caveats import check_measures


@dataclass(frozen=True, eq=False)
class Station:
    """One target of a layout.

    tip : its place, shape (k,); value : of the worst mode, None where no posture has one; joints : shape (n,), or None
    """

    name: str
    tip: Array
    value: float | None
    branch: str | None
    joints: Array | None


@dataclass(frozen=True, eq=False)
class Layout(Told):
    """A set of targets, and a better place for it. Made by `layout`.

    along, shift : the axes, and how far the work moves along each [m]
    turn : of the work about the vertical through `centre` [rad], before it moves; 0 where it was not asked for
    before, after : every target in its old and in its new place, each with its best posture
    goal : "worst" or "mean"; of the values that the measure has
    """

    plant: Plant
    measure: Measure
    goal: str
    along: tuple[str, ...]
    shift: Array
    turn: float
    centre: tuple[float, float]
    before: tuple[Station, ...]
    after: tuple[Station, ...]
    compensated: bool

    document: ClassVar = (
        "robot=plant.name",
        "measure=measure.name",
        "unit=measure.unit",
        "goal",
        "compensated",
        "shift=shifts",
        "turn",
        "centre",
        "score_before",
        "score_after",
        "unreachable",
        "before",
        "after",
    )

    @property
    def unreachable(self) -> tuple[str, ...]:
        """Names of the targets that have no posture in the new place."""
        return tuple(one.name for one in self.after if one.value is None)

    def score(self, stations: Sequence[Station]) -> float | None:
        """Worst or mean value over those that are reached; None where none is. For costs the worst is the largest."""
        values = [one.value for one in stations if one.value is not None]
        if not values:
            return None
        least = max if self.measure.small_is_good else min
        return float(least(values) if self.goal == WORST else np.mean(values))

    @property
    def shifts(self) -> dict[str, float]:
        """How far the work moves along each axis [m]."""
        return dict(zip(self.along, self.shift.tolist(), strict=True))

    @property
    def score_before(self) -> float | None:
        """The score of the old place."""
        return self.score(self.before)

    @property
    def score_after(self) -> float | None:
        """The score of the new place."""
        return self.score(self.after)

    def sheet(self) -> Sheet:
        """The move, a row a target, and whether all are in reach."""
        moves = ", ".join(f"{row} {number(value, 5)} m" for row, value in self.shifts.items())
        x, y = (number(value, 5) for value in self.centre)
        rows = [
            (one.name, _said(one.value), _said(other.value), other.branch or "")
            for one, other in zip(self.before, self.after, strict=True)
        ]
        unit = "" if self.measure.unit == "1" else f" [{self.measure.unit}]"
        return make_sheet(
            self.plant.name,
            f"layout by the {self.goal} {self.measure.name}{unit}",
            facts(
                ("move the work by", moves or "nothing"),
                ("turned about", f"x {x} m, y {y} m, by {number(self.turn, 5)} rad, before") if self.turn else None,
                ("or the base", "the opposite way"),
            ),
            table(
                [words("target"), Column("before"), Column("after"), words("branch")],
                [*rows, (self.goal, _said(self.score_before), _said(self.score_after), "")],
            ),
            answer(not self.unreachable, "All in reach", f"Out of reach: {', '.join(self.unreachable)}"),
        )


def layout(
    plant: Plant,
    targets: ArrayLike | Targets,
    measure: str = "alignment",
    *,
    goal: str = WORST,
    along: Sequence[str] | None = None,
    turn: bool = False,
    within: float | None = None,
    branch: str | None = None,
    loop: Asked = None,
) -> Layout:
    """Where to move a set of tip targets, all together, so that the worst or mean of a measure over them is best.

    Each target counts with its best posture. Places spread over the box of shifts are compared; from the best few,
    shift and all postures climb together in one nonlinear program with exact derivatives (`epigraph.ascend`). More
    targets within reach go before better values; those still out of reach are named and left out. Moving the work by a
    shift is moving the arm with its base by the opposite.

    targets : rows of task values, shape (T, k) [m, rad], or `read_targets(...)`
    measure : as in `postures`; alignment is 1 on the robust arm configurations
    along : task rows among x y z along which the work may move; all if left out
    turn : whether it may also turn about the vertical through its middle
    within : largest shift along each axis [m]; the arm's reach if left out
    branch : on which all targets are; each on its own best if left out
    Raises Unreachable where no place brings any target into reach; InputError, MissingExtra (extra `fast`).
    """
    objective = make_objective(plant, measure, loop)
    check_measures(plant, (objective.measure,), "layout")
    if goal not in GOALS:
        raise InputError(f'goal: "{goal}" is unknown. Give "worst" or "mean".')
    arm = plant.arm
    given = make_targets(arm.task, targets)
    largest = arm.mechanism.reach if within is None else positive_number("within", within, "m")
    placement = make_placement(arm.task, given.values, along, turn, largest)
    sides = branches_of(objective, None if branch is None else check_branch(branch))
    before = stand(objective, given.values, sides)
    shift, after = best_place(objective, given.values, placement, sides, before, goal)
    if not np.isfinite(after.values).any():
        raise Unreachable(f"targets: none is reached by {plant.name} within {largest:g} m. Give a larger --within.")
    moves = len(placement.along)
    return Layout(
        plant,
        objective.measure,
        goal,
        placement.along,
        shift[:moves],
        float(shift[moves]) if turn else 0.0,
        placement.centre,
        _stations(objective, given.names, given.values, before),
        _stations(objective, given.names, placement.moved(given.values, shift), after),
        objective.E is not None,
    )


def _stations(objective: Objective, names: tuple[str, ...], tips: Array, found: Standing) -> tuple[Station, ...]:
    return tuple(
        Station(name, tip, float(objective.sign * value), branch, joints)
        if np.isfinite(value)
        else Station(name, tip, None, None, None)
        for name, tip, value, branch, joints in zip(
            names, tips, found.values, found.branches, found.joints, strict=True
        )
    )


def _said(value: float | None) -> str:
    return "out of reach" if value is None else f"{value:.6g}"
