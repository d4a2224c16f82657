"""The task-space loop as it is closed: its rightmost pole, and how far its gains may rise. The slow measures."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexbase.checks import Array
from flexbase.measures.registry import Configuration, measure
from flexbase.trace.algebra import Scalar, stack

SCALES = np.logspace(-4.0, 4.0, 33)  # of the gains: where a change of stability is looked for
HALVINGS = 12  # of the interval in which it lies, a factor 1.8 wide: to 1.5e-4 relative


class TaskLoop(NamedTuple):
    """P(s) = R0/s^2 - U (S s^2 + Dp s + Kp)^-1 V^T of every configuration, shapes (..., rows, columns).  [theory §3]"""

    R0: Array
    U: Array
    V: Array
    S: Array
    Dp: Array
    Kp: Array

    def abscissa(self, stiffness: Array, damping: Array) -> Array:
        """Real part of the rightmost pole under f = -(stiffness y + damping y'), shape (...).

        States: the rigid motion r (r'' = R0 f), the base p (S p'' + Dp p' + Kp p = -V^T f), and y = r + U p.
        """
        k, m = self.U.shape[-2:]
        C = np.concatenate([np.broadcast_to(np.eye(k), (*self.U.shape[:-1], k)), self.U], axis=-1)
        drive = np.concatenate([self.R0, -np.linalg.solve(self.S, np.swapaxes(self.V, -1, -2))], axis=-2)
        own = np.zeros((*self.S.shape[:-2], k + m, 2 * (k + m)))
        own[..., k:, k : k + m] = -np.linalg.solve(self.S, self.Kp)
        own[..., k:, 2 * k + m :] = -np.linalg.solve(self.S, self.Dp)
        fed = np.concatenate([stiffness @ C, damping @ C], axis=-1)
        A = np.zeros((*own.shape[:-2], 2 * (k + m), 2 * (k + m)))
        A[..., : k + m, k + m :] = np.eye(k + m)
        A[..., k + m :, :] = own - drive @ fed
        return np.asarray(np.linalg.eigvals(A).real.max(axis=-1))


def _loop(configuration: Configuration) -> tuple[TaskLoop, Array, Array]:
    gains, reduced = configuration.gains, configuration.reduced
    assert gains is not None  # `needs_gains` asks for them before any cell is evaluated
    parts = [stack(part) for part in (reduced.R0, reduced.U, reduced.V, reduced.S)]
    parts += [stack(configuration.damping), stack(configuration.stiffness)]
    batch = np.broadcast_shapes(*(part.shape[:-2] for part in parts))
    wide = [np.broadcast_to(part, (*batch, *part.shape[-2:])) for part in parts]
    return TaskLoop(*wide), np.asarray(gains.stiffness), np.asarray(gains.damping)


@measure(
    "closed_loop_abscissa",
    unit="1/s",
    purpose="rightmost pole under the project's task gains; slow",
    zero_is="the limit of stability",
    needs=lambda m, n, k: None if m else "a base joint",
    slow=True,
    no_search="is slow and has no derivatives",
    small_is_good=True,
)
def closed_loop_abscissa(configuration: Configuration) -> Scalar:
    """Real part of the rightmost pole of the reduced loop, by LAPACK; negative where it settles.  [theory §3]

    Assumes ideal sensing, and arm motions outside the task damped by other means.
    """
    loop, stiffness, damping = _loop(configuration)
    return loop.abscissa(stiffness, damping)


@measure(
    "highest_gain",
    unit="1",
    purpose="scale s of the task gains (s Kp, sqrt(s) Kv) up to which the loop is stable; slow",
    needs=lambda m, n, k: None if m else "a base joint",
    slow=True,
    no_search="is slow and has no derivatives",
)
def highest_gain(configuration: Configuration) -> Scalar:
    """The largest s such that (s Kp, sqrt(s) Kv) is stable for it and all smaller of the scales looked at.

    Scales from 1e-4 to 1e4; 0 where the smallest is unstable, infinite where all are stable. Assumes ideal sensing.
    """
    loop, stiffness, damping = _loop(configuration)
    batch = loop.R0.shape[:-2]
    low, high, open_ = np.zeros(batch), np.full(batch, np.inf), np.ones(batch, dtype=bool)
    for scale in SCALES:
        stable = loop.abscissa(scale * stiffness, np.sqrt(scale) * damping) < 0.0
        low = np.where(open_ & stable, scale, low)
        high = np.where(open_ & ~stable, scale, high)
        open_ &= stable
    bracketed = (low > 0.0) & np.isfinite(high)
    for _ in range(HALVINGS if bracketed.any() else 0):
        middle = np.where(bracketed, np.sqrt(np.where(bracketed, low * high, 1.0)), 1.0)
        scales = middle[..., None, None]
        stable = loop.abscissa(scales * stiffness, np.sqrt(scales) * damping) < 0.0
        low, high = np.where(bracketed & stable, middle, low), np.where(bracketed & ~stable, middle, high)
    return np.where(open_, np.inf, low)
