"""The least value of several postures made as large as it gets, while each holds its tip: one nonlinear program."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import minimize

from flexbase.checks import Array
from flexbase.dynamics.inverse.newton import TOLERANCE, TipProblem, solve_rows
from flexbase.study.layout.placement import Placement
from flexbase.study.postures.objective import Objective

STEPS = 300
ENOUGH = 1e-14  # of the objective over its spread, between steps of the program
NOWHERE = -1e6  # stands for values where there is none, over the spread: the line search steps back
WORST, MEAN = "worst", "mean"
GOALS = (WORST, MEAN)


class Peak(NamedTuple):
    """A local optimum.

    joints : shape (T, n); shift : the placement's variables; values : the least of each posture, shape (T,)
    """

    joints: Array
    shift: Array
    values: Array


def ascend(
    objective: Objective,
    problem: TipProblem,
    targets: Array,
    starts: Array,
    placement: Placement,
    shift: Array,
    goal: str = WORST,
) -> Peak | None:
    """Improve postures, shape (T, n), for targets (T, k), and where these are placed; None where tips are lost.

    The minimum over modes, and over targets for `goal` "worst", has kinks. They are the constraints of
        maximise sum of t_j   subject to   v_ic(q_i) >= t_j(i)   and   tip(q_i) = target_i(shift),
    which is smooth; it is solved by sequential quadratic programming (SLSQP) with exact derivatives. Local.
    """
    T, n = starts.shape
    d = len(shift)
    heads = T if goal == MEAN else 1
    owner = np.arange(T) if goal == MEAN else np.zeros(T, dtype=int)
    scale = objective.spread
    last: list[Any] = [np.zeros(0), None]  # values and slopes are asked for in turn at the same place

    def split(z: Array) -> tuple[Array, Array, Array]:
        return z[:d], z[d : d + T * n].reshape(T, n), z[d + T * n :]

    def values(z: Array) -> Array:
        _, joints, heights = split(z)
        found = np.nan_to_num(objective(joints)[0] / scale, nan=NOWHERE)
        return np.asarray((found - heights[owner][:, None]).ravel())

    def values_slope(z: Array) -> Array:
        slopes = np.nan_to_num(objective(split(z)[1])[1] / scale, nan=0.0)
        c = slopes.shape[1]
        full = np.zeros((T, c, len(z)))
        for i in range(T):
            full[i, :, d + i * n : d + (i + 1) * n] = slopes[i]
            full[i, :, d + T * n + owner[i]] = -1.0
        return full.reshape(T * c, -1)

    def residual(z: Array) -> tuple[Array, Array]:
        if not np.array_equal(z, last[0]):
            place, joints, _ = split(z)
            last[:] = [z.copy(), problem.residual(joints, problem.aim(placement.moved(targets, place), T))]
        kept: tuple[Array, Array] = last[1]
        return kept

    def tips(z: Array) -> Array:
        return residual(z)[0].ravel()

    def tips_slope(z: Array) -> Array:
        place, J = split(z)[0], residual(z)[1]
        full = np.zeros((T, J.shape[1], len(z)))
        full[:, :, :d] = -placement.slope(targets, place)
        for i in range(T):
            full[i, :, d + i * n : d + (i + 1) * n] = J[i]
        return full.reshape(T * J.shape[1], -1)

    heights = objective.worst(starts) / scale
    if not np.isfinite(heights).all():
        return None
    first = heights if goal == MEAN else np.array([heights.min()])
    uphill = np.concatenate([np.zeros(d + T * n), np.full(heads, -1.0 / heads)])
    limits = [*placement.bounds, *[(None, None)] * (T * n + heads)]
    found = minimize(
        lambda z: float(uphill @ z),
        np.concatenate([shift, starts.ravel(), first]),
        jac=lambda z: uphill,
        bounds=limits,
        constraints=[
            {"type": "ineq", "fun": values, "jac": values_slope},
            {"type": "eq", "fun": tips, "jac": tips_slope},
        ],
        method="SLSQP",
        options={"maxiter": STEPS, "ftol": ENOUGH},
    )
    if not np.isfinite(found.x).all():
        return None
    place, joints, _ = split(found.x)
    place = placement.clipped(place)
    joints, errors = solve_rows(problem, joints, placement.moved(targets, place))
    if (errors > TOLERANCE * problem.scale).any():
        return None
    return Peak(joints, place, objective.worst(joints))
