"""The best posture for a tip target: over the branches of the arm and, where it is redundant, over its self-motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flexbase.checks import FARTHEST, Array, check_length, check_within
from flexbase.dynamics.inverse.arm_angles import arm_solutions
from flexbase.dynamics.inverse.branches import inside_branch
from flexbase.dynamics.inverse.newton import TOLERANCE, TipProblem, solve_rows
from flexbase.dynamics.inverse.self_motion import climb, idle_joints
from flexbase.dynamics.inverse.starts import spread_starts
from flexbase.errors import SingularArm, Unreachable
from flexbase.measures import Measure
from flexbase.model.loop import Asked
from flexbase.model.task import check_branch
from flexbase.plant import Plant, Pose
from flexbase.sheets.numbers import listed, number
from flexbase.sheets.plain import Plain
from flexbase.sheets.sheet import Column, Sheet, facts, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.study.layout.placement import Placement
from flexbase.study.postures.epigraph import ascend
from flexbase.study.postures.objective import Objective, make_objective
from flexbase.sweeps.caveats import check_measures

STARTS = 256  # of Newton, on each side of the elbow
CLIMBERS = 48  # of those on the target that are followed uphill, the best that lie apart
APART = 0.15  # sine of half the angle between them: 0.3 rad
PEAKS = 12  # smooth optima from which the ascent goes on to kinks
SHOWN = 12  # postures, the best
DISTINCT = 1e-3  # the same between postures; an ascent stops within 1e-7


@dataclass(frozen=True, eq=False)
class Posture(Plain):
    """One way to stand on a target.

    branch : as in `Plant.solutions`: the elbow's sign, or the signs of shoulder, elbow and wrist
    value : of the measure; of those with a value for each mode, the worst of `modes`
    modes : the measure's value for each mode, slowest first; one value where it has none for each mode
    """

    branch: str
    pose: Pose
    value: float
    modes: tuple[float, ...]

    document: ClassVar = ("branch", "value", "modes", "joints")

    @property
    def joints(self) -> Array:
        """Arm joints, shape (n,)."""
        return self.pose.joints


@dataclass(frozen=True, eq=False)
class Postures(Told):
    """The best posture for a target, and what else there is. Made by `postures`.

    found : best first; all solutions of an arm with n = k, the distinct local optima of a redundant one
    usual : the posture that `plant.at_tip` takes unasked, or None where that is singular
    """

    plant: Plant
    target: Array
    measure: Measure
    found: tuple[Posture, ...]
    usual: Posture | None
    compensated: bool

    document: ClassVar = (
        "robot=plant.name",
        "target",
        "measure=measure.name",
        "unit=measure.unit",
        "compensated",
        "postures=found",
        "usual",
    )

    @property
    def best(self) -> Posture:
        """The posture with the best value."""
        return self.found[0]

    def sheet(self) -> Sheet:
        """The best joints, a row a posture, and the posture that is taken unasked."""
        arm, several = self.plant.arm, len(self.best.modes) > 1
        named = [*((str(i), one) for i, one in enumerate(self.found[:SHOWN], start=1)), ("unasked", self.usual)]
        modes = [Column(f"mode {i + 1}") for i in range(len(self.best.modes) if several else 0)]
        unit = "" if self.measure.unit == "1" else self.measure.unit
        return make_sheet(
            self.plant.name,
            f"postures by {self.measure.name} {'with' if self.compensated else 'without'} compensator",
            facts(
                ("tip", listed(self.target, arm.task.rows, arm.task.units)),
                ("best joints", listed(self.best.joints, arm.joint_names, arm.joint_units)),
                ("shown", f"the best {SHOWN} of {len(self.found)}") if len(self.found) > SHOWN else None,
            ),
            table(
                [words("posture"), words("branch"), Column(self.measure.name, unit), *modes],
                (
                    [name, one.branch, *(number(value, 6) for value in (one.value, *(one.modes if several else ())))]
                    for name, one in named
                    if one is not None
                ),
            ),
        )


def postures(
    plant: Plant,
    target: Any,
    measure: str = "robustness",
    *,
    branch: str | None = None,
    loop: Asked = None,
    starts: int = STARTS,
) -> Postures:
    """The arm joints that reach a tip target and make a measure best, over all branches or on one.

    Where n = k all solutions are compared. A redundant arm climbs over its self-motion from many starts, with exact
    derivatives: first the smooth minimum over the modes, then the minimum itself, whose kinks are constraints of a
    nonlinear program (`epigraph.ascend`). Global as far as the starts are dense.

    target : one value for each task row [m, rad]
    measure : a name of `MEASURES`; made large, but for the costs `exact_gain` and `exact_radius`, made small
    branch : as in `Plant.at_tip`; all if left out
    starts : of a redundant arm, on each side of the elbow
    Joint limits are not looked at. Raises Unreachable, InputError, MissingExtra (extra `fast`).
    """
    objective = make_objective(plant, measure, loop)
    check_measures(plant, (objective.measure,), "posture")
    arm = plant.arm
    wanted = check_length("tip", target, arm.k, f"one for each task row, {' '.join(arm.task.rows)}")
    check_within("tip", wanted, FARTHEST, "rad or m")
    sides = ("+", "-") if branch is None else (check_branch(branch),)
    if arm.n > arm.k:
        rows = [(side, joints) for side in sides for joints in optima(objective, wanted, side, starts)]
    else:
        solutions = arm_solutions(arm.mechanism, arm.task, arm.base.equilibrium, wanted)
        rows = [(one.branch, one.joints) for one in solutions if branch is None or _agrees(one.branch, branch)]
    found = [one for side, joints in rows if (one := _posture(plant, objective, wanted, side, joints)) is not None]
    if not found:
        on = "any branch" if branch is None else f"branch {branch}"
        raise Unreachable(
            f"tip: {wanted.tolist()} is reached by {plant.name} on {on} in no posture that has a value of {measure}. "
            "Give a nearer target or another branch."
        )
    found.sort(key=lambda one: -objective.sign * one.value)
    usual = _usual(plant, objective, wanted, branch)
    return Postures(plant, wanted, objective.measure, tuple(found), usual, objective.E is not None)


def optima(objective: Objective, target: Array, side: str, count: int) -> list[Array]:
    """Distinct local optima of a redundant arm on one side, best first; none where the target is out of reach."""
    arm = objective.arm
    problem = TipProblem(arm.mechanism, arm.task, arm.base.equilibrium)
    inside = inside_branch(arm.mechanism, arm.base.equilibrium, side)
    starts = spread_starts(arm.mechanism, arm.parts, side, count)
    starts[:, idle_joints(problem)] = 0.0
    rows, errors = solve_rows(problem, starts, target)
    rows = rows[(errors <= TOLERANCE * problem.scale) & inside(rows)]
    values = objective.worst(rows)
    rows = _distinct(rows[np.isfinite(values)], values[np.isfinite(values)], APART)[:CLIMBERS]
    if not len(rows):
        return []
    joints, _, _ = climb(problem, inside, objective.smooth(), rows, target)
    joints = _distinct(joints, objective.worst(joints))[:PEAKS]
    values = objective.worst(joints)
    still = Placement(arm.task)
    for i, row in enumerate(joints):
        peak = ascend(objective, problem, target[None], row[None], still, np.zeros(0))
        if peak is not None and inside(peak.joints)[0] and peak.values[0] > values[i]:
            joints[i], values[i] = peak.joints[0], peak.values[0]
    kept = np.isfinite(values)
    return list(_distinct(joints[kept], values[kept]))


def _distinct(rows: Array, values: Array, gap: float = DISTINCT) -> Array:
    """Rows in falling order of value, none close to one before it; turns count modulo a full one."""
    chosen: list[Array] = []
    for row in rows[np.argsort(-values, kind="stable")]:
        if all(np.abs(np.sin(0.5 * (row - other))).max() > gap for other in chosen):
            chosen.append(row)
    return np.array(chosen).reshape(-1, rows.shape[1])


def _agrees(name: str, branch: str) -> bool:
    return name == branch or (len(branch) == 1 and len(name) == 3 and name[1] == branch)


def _posture(plant: Plant, objective: Objective, target: Array, branch: str, joints: Array) -> Posture | None:
    """A posture with its values, or None where it is singular or the measure has none."""
    values = objective.sign * objective(joints[None])[0][0]
    if not np.isfinite(values).all():
        return None
    try:
        pose = plant.at_tip(target, branch, near=joints) if plant.arm.has_gravity else plant.at(joints)
    except (SingularArm, Unreachable):
        return None
    worst = float(values.min() if objective.sign > 0.0 else values.max())
    return Posture(branch, pose, worst, tuple(values.tolist()))


def _usual(plant: Plant, objective: Objective, target: Array, branch: str | None) -> Posture | None:
    arm = plant.arm
    side = branch or arm.task.branch
    try:
        joints = plant.at_tip(target, side).joints
    except (SingularArm, Unreachable):
        return None
    return _posture(plant, objective, target, side, joints)
