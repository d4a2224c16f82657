"""Controllers of many runs as one: states padded to the longest, stepped together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexbase.checks import Array
from flexbase.control.joint_tracking import JointTracking
from flexbase.control.measured import Measured
from flexbase.sampled.controller import SampledController


class Settling:
    """tau = holding torque + the sampled controller's, on deviations from each run's goal."""

    def __init__(self, controllers: Sequence[SampledController], joints: Array, holding: Array) -> None:
        """joints, holding : of the goals, shape (runs, n)."""
        order = max(one.system.order for one in controllers)
        self._A = np.stack([_padded(one.system.A, (order, order)) for one in controllers])
        self._B = np.stack([_padded(one.system.B, (order, one.system.B.shape[1])) for one in controllers])
        self._C = np.stack([_padded(one.system.C, (len(one.system.C), order)) for one in controllers])
        self._D = np.stack([one.system.D for one in controllers])
        self._joints, self._holding = joints, holding
        self._x: Array | None = None

    def torque(self, tip_error: Array, joints: Array, accelerations: Array) -> Array:
        """The command of a sample, shape (runs, n)."""
        y = np.concatenate([tip_error, joints - self._joints, accelerations], axis=1)
        if self._x is None:
            self._x = self._at_rest(y)
        command = _times(self._C, self._x) + _times(self._D, y)
        self._x = _times(self._A, self._x) + _times(self._B, y)
        return np.asarray(self._holding + command)

    def _at_rest(self, y: Array) -> Array:
        """The state after the tip and the joints have stood where they are for long: no kick at the first sample.

        Where a controller integrates, the least such state of its other parts.
        """
        still = y.copy()
        still[:, -self._joints.shape[1] :] = 0.0
        rests = [
            np.linalg.lstsq(np.eye(len(A)) - A, B @ one, rcond=1e-9)[0] if len(A) else np.zeros(0)
            for A, B, one in zip(self._A, self._B, still, strict=True)
        ]
        return np.stack(rests)


class Tracking:
    """Each run's joint tracking by its encoders, for the first `samples`: rates are differences of readings."""

    def __init__(self, laws: Sequence[JointTracking], step: float, samples: int) -> None:
        self._laws, self._step, self.samples = laws, step, samples
        self._before: Array | None = None

    def torque(self, time: float, joints: Array) -> Array:
        """The command of a sample, shape (runs, n)."""
        before = joints if self._before is None else self._before
        rates = (joints - before) / self._step
        self._before = joints
        return np.array(
            [
                law.torque(Measured(time, tuple(q.tolist()), tuple(v.tolist()), (), ()))
                for law, q, v in zip(self._laws, joints, rates, strict=True)
            ],
            dtype=float,
        )


def _times(A: Array, x: Array) -> Array:
    return np.asarray((A @ x[:, :, None])[:, :, 0])


def _padded(A: Array, shape: tuple[int, int]) -> Array:
    whole = np.zeros(shape)
    whole[: A.shape[0], : A.shape[1]] = A
    return whole
