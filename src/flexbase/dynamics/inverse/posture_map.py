"""Best postures of a redundant arm for many targets at once, continued from target to neighbouring target."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from flexbase.checks import Array
from flexbase.dynamics.inverse.branches import Inside, inside_branch
from flexbase.dynamics.inverse.newton import TOLERANCE, TipProblem, solve_rows
from flexbase.dynamics.inverse.posture_criteria import Criterion
from flexbase.dynamics.inverse.self_motion import climb, idle_joints, tie_breaker
from flexbase.dynamics.inverse.starts import spread_starts
from flexbase.model.mechanism import Mechanism
from flexbase.model.task import Task

PIONEERS = 24  # targets that look globally, after the first
GLOBAL_STARTS = 32
LOST_STARTS = 8  # of targets that no neighbour reaches
BEST = 3  # starts of each that climb
NEIGHBOURS = 4
FIRST_CHUNK = 16  # targets continued from the first; then as many as are done
ROUNDS = 16  # in which better postures spread to neighbours
BETTER = 1e-6  # of a value: a neighbour's posture is left only for more than this, which keeps maps in one piece
TIED = 1e-3  # rad or m, of the tie breaker
OTHER = 0.3  # rad or m: a neighbour's posture nearer than this, taken to one's own target, is the same


class _Field(NamedTuple):
    """Postures found so far, filled in place.

    joints, values : shapes (T, n) and (T,); -inf where there is no posture yet
    """

    joints: Array
    values: Array

    @property
    def reached(self) -> NDArray[np.bool_]:
        return np.asarray(self.values > -np.inf)


class _Setting(NamedTuple):
    problem: TipProblem
    inside: Inside
    criterion: Criterion
    targets: Array


def best_postures(
    mechanism: Mechanism, task: Task, base_rest: Array, targets: Array, criterion: Criterion, branch: str = "+"
) -> tuple[Array, NDArray[np.bool_]]:
    """Joints that make a criterion largest over the self-motion at each target, and whether each is reached.

    Assumes n > k, and that targets lie densely enough for a posture to be continued from one to the next. A few targets
    are searched globally; the others begin from the nearest that are done. Then better postures spread from neighbour
    to neighbour until none improves. Postures are continuous except where the best one itself jumps, where equally
    good mirrored ones change places, or where the edge of the branch cuts.

    base_rest : shape (m,); targets : shape (T, k) [m, rad]
    Returns joints of shape (T, n), zero where there are none, and a mask of shape (T,).
    Raises InputError where the branch does not exist on this arm.
    """
    setting = _Setting(
        TipProblem(mechanism, task, base_rest), inside_branch(mechanism, base_rest, branch), criterion, targets
    )
    count = len(targets)
    field = _Field(np.zeros((count, setting.problem.n)), np.full(count, -np.inf))
    places = targets / np.where([unit == "rad" for unit in task.units], 1.0, setting.problem.scale)
    starts = spread_starts(mechanism, setting.problem.parts, branch, GLOBAL_STARTS)
    starts[:, idle_joints(setting.problem)] = 0.0
    order = np.random.default_rng(0).permutation(count)
    begin, size = 0, 1
    while begin < count:
        chunk = order[begin : begin + size]
        _continue(setting, field, places, chunk)
        lost = chunk[~field.reached[chunk]]
        _search(setting, field, lost, starts if begin == 0 else starts[:LOST_STARTS])
        begin, size = begin + size, max(FIRST_CHUNK, begin + size)
    _search(setting, field, order[1:PIONEERS], starts)
    _spread(setting, field, places)
    return field.joints, field.reached


def _continue(setting: _Setting, field: _Field, places: Array, cells: NDArray[np.int_]) -> None:
    """Begin cells from their nearest neighbours that are done: the first that arrives."""
    done = np.flatnonzero(field.reached)
    if not done.size:
        return
    near = done[cKDTree(places[done]).query(places[cells], k=np.arange(1, min(2, done.size) + 1))[1]]
    for column in near.T:
        left = ~field.reached[cells]
        _offer(setting, field, cells[left], field.joints[column[left]])


def _search(setting: _Setting, field: _Field, cells: NDArray[np.int_], starts: Array) -> None:
    """Offer the best of many starts to each cell."""
    if not cells.size:
        return
    problem = setting.problem
    rows = np.repeat(cells, len(starts))
    found, errors = solve_rows(problem, np.tile(starts, (len(cells), 1)), setting.targets[rows])
    good = (errors <= TOLERANCE * problem.scale) & setting.inside(found)
    values = np.full(len(rows), -np.inf)
    values[good] = np.nan_to_num(setting.criterion(found[good])[0], nan=-np.inf)
    ranked = np.argsort(-values.reshape(len(cells), -1), axis=1, kind="stable")[:, :BEST]
    pick = (np.arange(len(cells))[:, None] * len(starts) + ranked).ravel()
    pick = pick[np.isfinite(values[pick])]
    _offer(setting, field, rows[pick], found[pick])


def _spread(setting: _Setting, field: _Field, places: Array) -> None:
    """Offer each cell the postures of its neighbours, as long as any cell gains."""
    done = np.flatnonzero(field.reached)
    if done.size < 2:
        return
    near = done[cKDTree(places[done]).query(places[done], k=np.arange(1, min(NEIGHBOURS, done.size - 1) + 1) + 1)[1]]
    changed = field.reached.copy()
    for _ in range(ROUNDS):
        fresh, changed = changed, np.zeros_like(changed)
        asked = fresh[near] & (_gap(field.joints[near], field.joints[done][:, None]) > OTHER)
        row, column = np.nonzero(asked)
        changed[_offer(setting, field, done[row], field.joints[near[row, column]])] = True
        if not changed.any():
            break


def _offer(setting: _Setting, field: _Field, cells: NDArray[np.int_], starts: Array) -> NDArray[np.int_]:
    """Take starts to the cells' targets and uphill; cells that gain keep the outcome, and are returned.

    Of equally good postures the first by `tie_breaker` is kept, so that neighbours choose alike.
    """
    problem = setting.problem
    found, errors = solve_rows(problem, starts, setting.targets[cells])
    good = (errors <= TOLERANCE * problem.scale) & setting.inside(found)
    good &= ~field.reached[cells] | (_gap(found, field.joints[cells]) > OTHER)
    cells = cells[good]
    if not cells.size:
        return cells
    joints, values, _ = climb(problem, setting.inside, setting.criterion, found[good], setting.targets[cells])
    order = np.argsort(values, kind="stable")  # of several for one cell the best is written last
    cells, joints, values = cells[order], joints[order], values[order]
    old = field.values[cells]
    margin = BETTER * np.maximum(1.0, np.abs(np.where(np.isfinite(old), old, 1.0)))
    nearer = tie_breaker(joints) < tie_breaker(field.joints[cells]) - TIED
    gains = (values > old + margin) | ((values >= old - margin) & nearer)
    cells = cells[gains]
    field.joints[cells], field.values[cells] = joints[gains], values[gains]
    return np.unique(cells)


def _gap(a: Array, b: Array) -> Array:
    """The largest difference of a joint, turns modulo a full one, shape (...)."""
    return np.asarray(2.0 * np.abs(np.sin(0.5 * (a - b))).max(axis=-1))
