"""The best posture of a redundant arm: an ascent over the self-motion while the tip stays on its target."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.dynamics.inverse.branches import Inside, inside_branch
from flexbase.dynamics.inverse.newton import TOLERANCE, TipProblem, solve_rows
from flexbase.dynamics.inverse.posture_criteria import Criterion
from flexbase.dynamics.inverse.starts import STARTS, spread_starts
from flexbase.model.mechanism import Mechanism
from flexbase.model.task import Task

CLIMBS = 40  # steps of an ascent
CLIMBERS = 8  # starts that are followed uphill, of all that reach the target
LARGEST_CLIMB = 0.4  # rad or m
ARRIVED = 1e-7  # rad or m: the next quadratic step would be at rounding
ENOUGH = 1e-12  # of a value: what the step now promises; after it joints are right to rounding
PROBE = 1e-5  # rad or m, of the second differences
FLOOR = 1e-3  # of the largest curvature: flatter directions count as this curved
HALVINGS = 6
RETRACTIONS = 12  # Newton steps back onto the target
TIE = 1e-9  # of a value: of postures as good as this the first by `tie_breaker` is taken
DISTINCT = 1e-3  # rad or m, between postures


class Posture(NamedTuple):
    """An optimum over the self-motion.

    joints : arm joints, shape (n,), revolute ones in (-pi, pi]
    value : of the criterion
    slope : length of the criterion's gradient along the self-motion; near 0 except where the branch's edge stops it
    """

    joints: Array
    value: float
    slope: float


def best_posture(
    mechanism: Mechanism,
    task: Task,
    base_rest: Array,
    target: Array,
    criterion: Criterion,
    branch: str = "+",
    *,
    starts: Array | None = None,
    climbers: int = CLIMBERS,
) -> Posture | None:
    """The arm joints on a branch that reach a target and make a criterion largest, or None where none reaches it.

    Assumes n > k and a criterion that is smooth wherever the arm is regular. Newton steps bring many starts to the
    target; the best distinct ones climb along the null space of the task, in Newton steps with second differences of
    the gradient, each taken back onto the target. Global as far as the starts are dense: a local ascent finds no more.

    base_rest : base joints, shape (m,); target : shape (k,) [m, rad]
    starts : rows to begin from, shape (S, n); low-discrepancy ones if left out
    Raises InputError where the branch does not exist on this arm.
    """
    problem, inside = TipProblem(mechanism, task, base_rest), inside_branch(mechanism, base_rest, branch)
    if starts is None:
        starts = spread_starts(mechanism, problem.parts, branch, STARTS)
        starts[:, idle_joints(problem)] = 0.0
    found, errors = solve_rows(problem, np.atleast_2d(starts), target)
    found = found[(errors <= TOLERANCE * problem.scale) & inside(found)]
    if not len(found):
        return None
    chosen = _best_distinct(found, criterion(found)[0], climbers)
    joints, values, slopes = climb(problem, inside, criterion, chosen, target)
    tied = np.flatnonzero(values >= values.max() - TIE * max(1.0, abs(values.max())))
    best = tied[np.argmin(tie_breaker(joints[tied]))] if tied.size else 0
    return Posture(joints[best], float(values[best]), float(slopes[best]))


def _best_distinct(joints: Array, values: Array, count: int) -> Array:
    """Rows in falling order of value, none close to one before it."""
    chosen: list[Array] = []
    for row in joints[np.argsort(-np.nan_to_num(values, nan=-np.inf), kind="stable")]:
        if all(np.abs(np.sin(0.5 * (row - other))).max() > DISTINCT for other in chosen):
            chosen.append(row)
        if len(chosen) == count:
            break
    return np.array(chosen)


def tie_breaker(joints: Array) -> Array:
    """Distance of joints (S, n) from 0.1 rad or m each, shape (S,): small for near ones, unlike for mirrored ones."""
    return np.asarray(np.linalg.norm(joints - 0.1, axis=1))


def idle_joints(problem: TipProblem) -> NDArray[np.bool_]:
    """Arm joints that never move the task, such as the last one where only positions count, shape (n,)."""
    rows = np.random.default_rng(0).uniform(-2.0, 2.0, (8, problem.n))
    _, J = problem.residual(rows, problem.aim(np.zeros(problem.task.k), len(rows)))
    return np.asarray(np.abs(J).max(axis=(0, 1)) <= 1e-9 * np.abs(J).max())


def climb(
    problem: TipProblem, inside: Inside, criterion: Criterion, starts: Array, targets: Array
) -> tuple[Array, Array, Array]:
    """Local optima over the self-motion: joints (S, n), values (S,) and remaining slopes along it (S,).

    Assumes that every start, shape (S, n), reaches its target, shape (k,) or (S, k), on the branch.
    """
    joints = starts.copy()
    aims = np.broadcast_to(targets, (len(joints), problem.task.k))
    values, gradients = criterion(joints)
    slopes = np.zeros(len(joints))
    active = np.arange(len(joints))
    for _ in range(CLIMBS):
        if not active.size:
            break
        step, slope, gain = _uphill(problem, criterion, joints[active], gradients[active], aims[active])
        slopes[active] = slope
        rough = (np.abs(step).max(axis=1, initial=0.0) > ARRIVED) & (gain > ENOUGH * np.abs(values[active]))
        moved = _line_search(problem, inside, criterion, joints, values, gradients, aims, active, step, gain)
        active = active[moved & rough]
    joints, _ = solve_rows(problem, joints, aims, RETRACTIONS)
    return joints, criterion(joints)[0], slopes


def _uphill(
    problem: TipProblem, criterion: Criterion, joints: Array, gradients: Array, aims: Array
) -> tuple[Array, Array, Array]:
    """Newton steps along the null space, made to climb by the size of each curvature; slopes, and first-order gains.

    The curvature is that of the criterion along the self-motion itself, so the bending of the task enters with the
    multipliers of J: Z^T (grad f - J^T multipliers)' Z, with the multipliers held.
    """
    count, n = joints.shape
    _, J = problem.residual(joints, problem.aim(aims, count))
    U, sizes, Vt = np.linalg.svd(J)
    k = J.shape[1]
    Z = np.swapaxes(Vt[:, k:], 1, 2)
    inverse = np.where(sizes > 1e-12 * sizes[:, :1], 1.0 / np.maximum(sizes, 1e-300), 0.0)
    multipliers = np.einsum("skj,sj,sji,si->sk", U, inverse, Vt[:, :k], gradients)
    slope = np.einsum("sir,si->sr", Z, gradients)
    r = n - k
    probes = (joints + PROBE * np.moveaxis(Z, 2, 0)).reshape(-1, n)
    bends = problem.residual(probes, problem.aim(np.tile(aims, (r, 1)), len(probes)))[1].reshape(r, *J.shape) - J
    bent = criterion(probes)[1].reshape(r, count, n) - gradients - np.einsum("qski,sk->qsi", bends, multipliers)
    H = np.einsum("qsi,sir->sqr", bent / PROBE, Z)
    H = np.where(np.isfinite(H).all(axis=(1, 2))[:, None, None], H, np.eye(r))
    curvature, turn = np.linalg.eigh(0.5 * (H + np.swapaxes(H, 1, 2)))
    size = np.abs(curvature)
    size = np.maximum(size, np.maximum(FLOOR * size.max(axis=1, keepdims=True), 1e-300))
    step = np.einsum("sir,srp,sp->si", Z, turn, np.einsum("srp,sr->sp", turn, slope) / size)
    step *= np.minimum(1.0, LARGEST_CLIMB / np.maximum(np.abs(step).max(axis=1), 1e-300))[:, None]
    return step, np.linalg.norm(slope, axis=1), np.einsum("si,si->s", step, gradients)


def _line_search(
    problem: TipProblem,
    inside: Inside,
    criterion: Criterion,
    joints: Array,
    values: Array,
    gradients: Array,
    aims: Array,
    active: NDArray[np.int_],
    step: Array,
    gain: Array,
) -> NDArray[np.bool_]:
    """Halve steps until they climb, on the target and on the branch; updates the rows in place and says which moved."""
    moved, length = np.zeros(len(active), dtype=bool), 1.0
    for _ in range(HALVINGS):
        left = np.flatnonzero(~moved)
        if not left.size:
            break
        rows = active[left]
        trial, errors = solve_rows(
            problem, joints[rows] + length * step[left], aims[rows], RETRACTIONS, 0.1 * TOLERANCE
        )
        value, gradient = criterion(trial)
        climbs = value >= values[rows] + 1e-4 * length * gain[left]
        good = climbs & (errors <= TOLERANCE * problem.scale) & inside(trial) & np.isfinite(gradient).all(axis=1)
        joints[rows[good]], values[rows[good]], gradients[rows[good]] = trial[good], value[good], gradient[good]
        moved[left[good]] = True
        length *= 0.5
    return moved
