"""The search for a layout: many places compared, then an ascent of the place and all postures together."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.inverse.branches import inside_branch
from flexbase.dynamics.inverse.newton import TipProblem
from flexbase.dynamics.inverse.two_joint_arm import two_joint_arm
from flexbase.study.layout.placement import Placement
from flexbase.study.layout.postures_on_targets import Standing, better_of, stand
from flexbase.study.postures.epigraph import WORST, ascend
from flexbase.study.postures.objective import Objective

CLOSED, SOLVED, CLIMBED = 20_000, 300, 40  # places compared, by what a target costs: a formula, Newton steps, an ascent
ZOOMS, ZOOMED, ZOOM = 60, 150, 2.0  # a formula: the best places looked at closely, with how many, of the spacing
CLIMBERS = 6  # places from which the program ascends; half as many where targets cost more than a formula
APART = 0.02  # between those places, of the box
ROUNDS = 2  # of ascent and a fresh look at every target's postures


def best_place(
    objective: Objective, targets: Array, placement: Placement, sides: tuple[str, ...], before: Standing, goal: str
) -> tuple[Array, Standing]:
    """The best shift and every target's posture there."""
    arm = objective.arm
    low, high = np.array(placement.bounds).T
    quick = two_joint_arm(arm.mechanism, arm.task, arm.base.equilibrium) is not None
    count = CLOSED if quick else SOLVED if arm.n == arm.k else CLIMBED
    shifts = low + (high - low) * _unit(placement.size, count)
    shifts[0] = 0.0
    if placement.turns:
        shifts[1 : count // 4, -1] = 0.0
    parts = _stand_all(objective, targets, placement, shifts, sides)
    parts[0] = better_of(parts[0], before)
    order = _apart(_ranked(parts, goal), shifts / (high - low), ZOOMS)
    if quick:
        size = ZOOM * (high - low) * count ** (-1.0 / placement.size)
        cloud = (_unit(placement.size, ZOOMED) - 0.5) * size
        shifts = np.concatenate([shifts[order], *(placement.clipped(shifts[i] + cloud) for i in order)])
        parts = [*(parts[i] for i in order), *_stand_all(objective, targets, placement, shifts[len(order) :], sides)]
        order = _apart(_ranked(parts, goal), shifts / (high - low), ZOOMS)
    best_shift, best = shifts[order[0]], parts[order[0]]
    for i in order[: CLIMBERS if quick else CLIMBERS // 2]:
        shift, found = _climb(objective, targets, placement, sides, shifts[i], parts[i], goal)
        if rank(found.values, goal) > rank(best.values, goal):
            best_shift, best = shift, found
    return best_shift, best


def _unit(dimensions: int, count: int) -> Array:
    from scipy.stats import qmc  # half a second to import

    return np.asarray(qmc.Halton(dimensions, scramble=False).random(count))


def _stand_all(
    objective: Objective, targets: Array, placement: Placement, shifts: Array, sides: tuple[str, ...]
) -> list[Standing]:
    """Every target's posture in every place."""
    T = len(targets)
    found = stand(objective, np.concatenate([placement.moved(targets, shift) for shift in shifts]), sides)
    edges = range(0, len(shifts) * T, T)
    return [Standing(found.joints[i : i + T], found.values[i : i + T], found.branches[i : i + T]) for i in edges]


def _ranked(parts: list[Standing], goal: str) -> list[int]:
    return sorted(range(len(parts)), key=lambda i: rank(parts[i].values, goal), reverse=True)


def _apart(order: list[int], places: Array, count: int) -> list[int]:
    """The first of an order whose places lie apart from those before them."""
    chosen: list[int] = []
    for i in order:
        if all(np.abs(places[i] - places[j]).max() > APART for j in chosen):
            chosen.append(i)
        if len(chosen) == count:
            break
    return chosen


def _climb(
    objective: Objective,
    targets: Array,
    placement: Placement,
    sides: tuple[str, ...],
    shift: Array,
    start: Standing,
    goal: str,
) -> tuple[Array, Standing]:
    """Ascend with all targets in reach; then look again at each one's postures, as long as that gains."""
    arm = objective.arm
    problem = TipProblem(arm.mechanism, arm.task, arm.base.equilibrium)
    best = start
    for _ in range(ROUNDS):
        held = np.flatnonzero(np.isfinite(best.values))
        if not held.size:
            break
        peak = ascend(objective, problem, targets[held], best.joints[held], placement, shift, goal)
        if peak is None:
            break
        fresh = stand(objective, placement.moved(targets, peak.shift), sides)
        joints, values, branches = fresh.joints.copy(), fresh.values.copy(), list(fresh.branches)
        for row, i in enumerate(held):
            side = best.branches[i]
            on = bool(inside_branch(arm.mechanism, arm.base.equilibrium, side)(peak.joints[row : row + 1])[0])
            if peak.values[row] > values[i] and (on or len(sides) > 1):
                joints[i], values[i] = peak.joints[row], peak.values[row]
                branches[i] = side if on else _side(objective, peak.joints[row], sides)
        found = Standing(joints, values, tuple(branches))
        if not rank(found.values, goal) > rank(best.values, goal):
            break
        shift, best = peak.shift, found
    return shift, best


def rank(values: Array, goal: str) -> tuple[int, float]:
    """How good values over the targets are: first how many there are, then the worst or the mean."""
    known = values[np.isfinite(values)]
    if not known.size:
        return 0, -np.inf
    return known.size, float(known.min() if goal == WORST else known.mean())


def _side(objective: Objective, joints: Array, sides: tuple[str, ...]) -> str:
    arm = objective.arm
    for side in sides:
        if inside_branch(arm.mechanism, arm.base.equilibrium, side)(joints[None])[0]:
            return side
    return ""
