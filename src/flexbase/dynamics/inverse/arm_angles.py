"""Inverse kinematics of any serial arm: closed forms where there are any, else damped Newton steps from many starts."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.dynamics.inverse.branches import NAMES, inside_branch, matching, places
from flexbase.dynamics.inverse.newton import TOLERANCE, TipProblem, solve_rows
from flexbase.dynamics.inverse.posture_criteria import Criterion, isotropy
from flexbase.dynamics.inverse.posture_map import best_postures
from flexbase.dynamics.inverse.self_motion import best_posture
from flexbase.dynamics.inverse.six_joint_arm import ROUNDED, SixJointArm, six_joint_arm, solve_six_joint_arm
from flexbase.dynamics.inverse.starts import STARTS, spread_starts
from flexbase.dynamics.inverse.two_joint_arm import TwoJointArm, solve_two_joint_arm, two_joint_arm
from flexbase.errors import InputError
from flexbase.model.mechanism import Mechanism
from flexbase.model.task import BRANCHES, Task

FEW_STARTS = 8
STRETCHED = 1.0 + 1e-12  # cosine of the elbow, to rounding, at the edge of reach
DISTINCT = 1e-6  # rad or m, between solutions; Newton steps agree to 1e-9 except next to a singular arm


class Solution(NamedTuple):
    """One way to reach a target.

    branch : shoulder, elbow and wrist signs of an arm with six joints; else the sign of the elbow
    joints : arm joints, shape (n,), revolute ones in (-pi, pi]
    """

    branch: str
    joints: Array


def arm_angles(
    mechanism: Mechanism,
    task: Task,
    base_rest: Array,
    target: Array,
    branch: str,
    near: Array | None = None,
    criterion: Criterion | None = None,
) -> tuple[Array | None, float]:
    """Arm joints that bring the tip to a target while the base rests, and the smallest tip error that was found.

    Of several solutions on the branch the one nearest to `near` is taken. Without it: of a redundant arm the best over
    its self-motion, by `criterion` or else by `isotropy`; of an arm with named branches the first in the order of
    NAMES; else the one nearest to zero. None where no start arrives.

    branch : as in `inside_branch`; base_rest : shape (m,); target : shape (k,) [m, rad]; near : shape (n,)
    Raises InputError where the branch does not exist on this arm.
    """
    planar = two_joint_arm(mechanism, task, base_rest)
    inside = inside_branch(mechanism, base_rest, branch)
    if planar is not None:
        return _planar_angles(planar, target, branch)
    six = _closed_six(mechanism, task, base_rest)
    if six is not None:
        allowed = [NAMES[i] for i in matching(branch)]
        solutions = [one for one in _six_solutions(six, mechanism, task, base_rest, target) if one.branch in allowed]
        if solutions:
            gaps = [0.0 if near is None else float(np.linalg.norm(one.joints - near)) for one in solutions]
            return solutions[int(np.argmin(gaps))].joints, 0.0
    n = mechanism.N - len(base_rest)
    if n > task.k and near is None:
        best = best_posture(
            mechanism, task, base_rest, target, criterion or isotropy(mechanism, task, base_rest), branch
        )
        if best is not None:
            return best.joints, 0.0
    problem = TipProblem(mechanism, task, base_rest)
    starts = spread_starts(mechanism, problem.parts, branch, STARTS)
    if near is not None:
        starts[0] = near
    found, errors = solve_rows(problem, starts, target)
    good = (errors <= TOLERANCE * problem.scale) & inside(found)
    if not good.any() or six is not None:
        return None, float(errors.min())
    centre = np.zeros(n) if near is None else near
    return found[good][np.argmin(np.linalg.norm(found[good] - centre, axis=1))], 0.0


def arm_solutions(mechanism: Mechanism, task: Task, base_rest: Array, target: Array) -> list[Solution]:
    """All distinct ways to reach a target while the base rests, in the order of their branches.

    Assumes as many task rows as arm joints. Arms with named branches and two parallel joints: complete, and no two
    share a name except next to a singular arm. Others: all that Newton steps from many starts find, named
    by the elbow, so that several may share a sign. Empty where the target is out of reach.

    base_rest : shape (m,); target : shape (k,) [m, rad]
    Raises InputError for a redundant arm, which has infinitely many.
    """
    n = mechanism.N - len(base_rest)
    if n > task.k:
        raise InputError(
            f"solutions: {n} arm joints for {task.k} task rows leave infinitely many. "
            "Take at_tip, with near or without."
        )
    planar = two_joint_arm(mechanism, task, base_rest)
    if planar is not None:
        pairs = [(branch, _planar_angles(planar, target, branch)[0]) for branch in BRANCHES[:2]]
        return [Solution(branch, joints) for branch, joints in pairs if joints is not None]
    six = _closed_six(mechanism, task, base_rest)
    if six is not None:
        return _six_solutions(six, mechanism, task, base_rest, target)
    problem = TipProblem(mechanism, task, base_rest)
    starts = np.concatenate([spread_starts(mechanism, problem.parts, sign, STARTS) for sign in BRANCHES[:2]])
    found, errors = solve_rows(problem, starts, target)
    rows = _distinct(problem, found[errors <= TOLERANCE * problem.scale])
    plus = inside_branch(mechanism, base_rest, "+")(rows)
    order = np.lexsort((np.linalg.norm(rows, axis=1), ~plus))
    return [Solution("+" if plus[i] else "-", rows[i]) for i in order]


def arm_angles_of_many(
    mechanism: Mechanism, task: Task, base_rest: Array, targets: Array, branch: str, criterion: Criterion | None = None
) -> tuple[Array, NDArray[np.bool_]]:
    """Arm joints for many targets, shape (T, k), and whether each is reached, shape (T,).

    In closed form for two parallel joints and, with a Newton polish, for full poses of arms with named branches (a
    branch of one sign takes the first that exists, in the order of NAMES). Redundant arms: the best over the
    self-motion, by `criterion` or else by `isotropy`, continuous from target to target where the optimum is. Other
    arms by Newton steps from `FEW_STARTS` starts, the first to arrive.

    base_rest : shape (m,). Returns joints of shape (T, n), zero where a target is not reached.
    Raises InputError where the branch does not exist on this arm.
    """
    planar = two_joint_arm(mechanism, task, base_rest)
    inside = inside_branch(mechanism, base_rest, branch)
    if planar is not None:
        first, second, cosine = solve_two_joint_arm(planar, targets[:, 0], targets[:, 1], branch)
        return np.column_stack([first, second]), np.asarray(np.abs(cosine) <= STRETCHED)
    problem = TipProblem(mechanism, task, base_rest)
    if problem.n > task.k:
        chosen = criterion or isotropy(mechanism, task, base_rest)
        return best_postures(mechanism, task, base_rest, targets, chosen, branch)
    six = _closed_six(mechanism, task, base_rest)
    joints = np.zeros((len(targets), problem.n))
    reached = np.zeros(len(targets), dtype=bool)
    if six is not None:
        candidates, exists = _six_candidates(six, problem, targets)
        tries = [(candidates[:, i], exists[:, i]) for i in matching(branch)]
    else:
        starts = spread_starts(mechanism, problem.parts, branch, FEW_STARTS)
        tries = [(np.broadcast_to(start, joints.shape), np.ones(len(targets), dtype=bool)) for start in starts]
    for begin, offered in tries:
        cells = np.flatnonzero(~reached & offered)
        found, errors = solve_rows(problem, begin[cells], targets[cells])
        good = (errors <= TOLERANCE * problem.scale) & inside(found)
        joints[cells[good]], reached[cells[good]] = found[good], True
    return joints, reached


def _planar_angles(planar: TwoJointArm, target: Array, branch: str) -> tuple[Array | None, float]:
    first, second, cosine = solve_two_joint_arm(planar, target[0], target[1], branch)
    if abs(float(cosine)) <= STRETCHED:
        return np.array([first, second]), 0.0
    distance = float(np.hypot(*(target - planar.shoulder)))
    return None, max(distance - planar.upper - planar.fore, abs(planar.upper - planar.fore) - distance, 0.0)


def _closed_six(mechanism: Mechanism, task: Task, base_rest: Array) -> SixJointArm | None:
    """The geometry with which a full pose is solved in closed form, or None."""
    return six_joint_arm(mechanism, base_rest) if task.k == 6 else None


def _six_candidates(six: SixJointArm, problem: TipProblem, targets: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Closed-form joints, shape (T, 8, 6), sorted into the places of NAMES, and whether each exists, shape (T, 8)."""
    aim = problem.aim(targets, len(targets))
    raw, exists = solve_six_joint_arm(six, aim.position, aim.rotation)
    cells, slots = np.nonzero(exists)
    place = places(six, raw[cells, slots])
    joints, there = np.zeros_like(raw), np.zeros(exists.shape, dtype=bool)
    joints[cells, place], there[cells, place] = raw[cells, slots], True
    return problem.wrapped(joints.reshape(-1, 6)).reshape(joints.shape), there


def _six_solutions(
    six: SixJointArm, mechanism: Mechanism, task: Task, base_rest: Array, target: Array
) -> list[Solution]:
    problem = TipProblem(mechanism, task, base_rest)
    aim = problem.aim(target, 1)
    raw, exists = solve_six_joint_arm(six, aim.position, aim.rotation)
    starts = raw[0][exists[0]]
    if six.distance > ROUNDED:  # two candidates may merge where the arm itself has two solutions
        more = [spread_starts(mechanism, problem.parts, sign, STARTS) for sign in BRANCHES[:2]]
        starts = np.concatenate([starts, *more])
    found, errors = solve_rows(problem, starts, target)
    rows = _distinct(problem, found[errors <= TOLERANCE * problem.scale])
    place = places(six, rows)
    return [Solution(NAMES[place[i]], rows[i]) for i in np.argsort(place, kind="stable")]


def _distinct(problem: TipProblem, rows: Array) -> Array:
    """The first of each cluster of rows; turns count modulo a full one."""
    kept: list[Array] = []
    for row in rows:
        gaps = [np.where(problem.revolute, 2.0 * np.sin(0.5 * (row - other)), row - other) for other in kept]
        if all(np.abs(gap).max() > DISTINCT for gap in gaps):
            kept.append(row)
    return np.array(kept).reshape(-1, problem.n)
