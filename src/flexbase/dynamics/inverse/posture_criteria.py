"""Criteria of a posture: smooth scalars of the arm joints with their gradients, to be made large."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.kinematics import forward, jacobian
from flexbase.model.mechanism import Mechanism
from flexbase.model.parts import base_first
from flexbase.model.task import Task
from flexbase.trace.algebra import stack, unstack

Criterion = Callable[[Array], tuple[Array, Array]]
"""Rows of arm joints, shape (S, n), to values, shape (S,), and gradients, shape (S, n). -inf or NaN: never taken."""


def isotropy(mechanism: Mechanism, task: Task, base_rest: Array) -> Criterion:
    """Logarithm of the geometric over the arithmetic mean of the eigenvalues of Jv Jv^T, with its gradient.  [K91]

    0 where Jv is equally strong in all task directions, -inf where the arm is singular. Unlike the ratio of singular
    values it is smooth where two of them meet. With one task row it is log(Jv Jv^T). Metres and radians count alike.

    base_rest : base joints, shape (m,)
    """
    base, rows = tuple(map(float, base_rest)), list(task.indices)
    parts = base_first(len(base), mechanism.N)
    k = len(rows)

    def criterion(joints: Array) -> tuple[Array, Array]:
        frames = forward(mechanism, parts.whole(base, unstack(joints, 1)))
        full = parts.arm(np.broadcast_to(stack(jacobian(frames)), (len(joints), 6, mechanism.N)))
        J = full[:, rows]
        gram = J @ np.swapaxes(J, 1, 2)
        sign, log_det = np.linalg.slogdet(gram)
        regular = (sign > 0.0) & np.isfinite(log_det)
        gram[~regular] = np.eye(k)
        trace = np.trace(gram, axis1=1, axis2=2)
        shared = k > 1
        value = np.where(regular, log_det / k - shared * np.log(trace / k), -np.inf)
        slope = 2.0 * (np.linalg.solve(gram, J) / k - shared * J / trace[:, None, None])
        weight = np.zeros_like(full)
        weight[:, rows] = slope
        return value, jacobian_slope(full, weight)

    return criterion


def jacobian_slope(J: Array, weight: Array) -> Array:
    """Gradient by the joints, shape (S, n), of the sum of `weight` times J, both (S, 6, n), of a serial chain.

    Column i of J is the tool's velocity v_i and the angular velocity w_i of joint i. Joint j turns the columns of
    itself and of all later joints, dv_i = w_j x v_i and dw_i = w_j x w_i, and moves the tool for the earlier ones,
    dv_i = w_i x v_j.
    """
    v, w = np.swapaxes(J[:, :3], 1, 2), np.swapaxes(J[:, 3:], 1, 2)
    a, b = np.swapaxes(weight[:, :3], 1, 2), np.swapaxes(weight[:, 3:], 1, 2)
    moments = np.cross(v, a) + np.cross(w, b)
    later = np.cumsum(moments[:, ::-1], axis=1)[:, ::-1]
    pushes = np.cross(a, w)
    earlier = np.cumsum(pushes, axis=1) - pushes
    return np.asarray((w * later).sum(axis=2) + (v * earlier).sum(axis=2))
