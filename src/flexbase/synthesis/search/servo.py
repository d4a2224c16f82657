"""Loop shaping of the arm's joints on a base that floats, and a slow loop around it that takes the tip error away.

A controller that is made with the base's modes in its model resonates where the model does; at 1 % damping a base that
is 20 % off then stands in the wrong phase, and the changed robot is lost. This one has no base mode to be wrong about:
above its modes a base is as free as if it floated, and at them joint torques that lead the joints' angles take energy
out of it. On eight poses of a UR5e's pedestal, stripped of its damping and 0.3 to 4 times as stiff, all loops settle.

On a floating base the arm's inertia is F = Mhat - Map Mpp^-1 Mpa = L L^T, and tau = w L u, y = w L^T dq makes of all
its directions, the self-motion's too, one and the same w^2/s^2: one small scalar loop is designed, and used n times.

What the base gives way the joints do not show. So they are moved against the tip error, far slower than the base moves.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexbase.checks import Array
from flexbase.linear.discrete.coprime import coprime_controller
from flexbase.linear.discrete.system import Discrete, delay, hold, series, side_by_side, static
from flexbase.linear.second_order import StateSpace
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose

FACTOR = 1.03  # on gamma; 1.1 costs a hundredth or two of disk margin on a UR5e
SINGULAR = 1e-4  # of the tip's mean mobility: directions of less are let go


class Slow(NamedTuple):
    """The joints' goal moves by -ratio e at rest, by nothing above `roll`.

    speed : crossover [rad/s]; roll : of a second pole [rad/s]; ratio / (1 + ratio) of a tip error is taken away
    """

    speed: float
    roll: float
    ratio: float = 10.0

    def sampled(self, step: float) -> Discrete:
        """ratio / ((1 + s ratio/speed) (1 + s/roll))"""
        return series(_lowpass(self.speed / self.ratio, self.ratio, step), _lowpass(self.roll, 1.0, step))


def joint_servo(
    pose: Pose, sensing: Sensing, gains: Gains, scale: float, weight: Discrete, slow: Slow | None
) -> tuple[Discrete, float]:
    """A controller from tip error, joints and accelerations, which are not heard, to torques; and the servo's b_opt.

    Its stiffness per inertia at speed, w^2, is the mean of what scale Kp gives the task on a floating base.

    weight : on every joint, a scalar system; the controller has its states twice, and delay + 2, for each joint
    slow : two states more for each task row; None: the tip error is not heard
    Raises Unsolvable where the loop shaping has no solution.
    """
    n, k = pose.arm.n, pose.arm.k
    inertia, Jv = pose.Ms, pose.Jv
    mobility = Jv @ np.linalg.solve(inertia, Jv.T)
    w = float(np.sqrt(scale * np.trace(gains.stiffness @ mobility) / k))
    one, b_opt = _scalar(w, sensing, weight)
    L = np.asarray(w * np.linalg.cholesky(inertia))
    towards = _towards(inertia, Jv, gains)
    goal = static(np.zeros((k, k)), sensing.step) if slow is None else side_by_side(*[slow.sampled(sensing.step)] * k)
    hears = side_by_side(
        series(goal, static(L.T @ towards, sensing.step)), static(np.hstack([L.T, np.zeros((n, n))]), sensing.step)
    )
    offset = series(hears, static(np.hstack([np.eye(n), np.eye(n)]), sensing.step))
    return series(series(offset, side_by_side(*[one] * n)), static(L, sensing.step)), b_opt


def _towards(inertia: Array, Jv: Array, gains: Gains) -> Array:
    """Joint motions of least energy by which the tip moves as asked, shape (n, k); task rows by their stiffness."""
    k = len(Jv)
    R = np.linalg.cholesky(gains.stiffness + 1e-9 * np.trace(gains.stiffness) * np.eye(k))
    pulled = np.linalg.solve(inertia, Jv.T) @ R
    mobility = R.T @ Jv @ pulled
    kept = mobility + SINGULAR * np.trace(mobility) / k * np.eye(k)
    return np.asarray(pulled @ np.linalg.inv(kept) @ R.T)


def _lowpass(corner: float, gain: float, step: float) -> Discrete:
    pole = np.exp(-corner * step)
    return Discrete(np.array([[pole]]), np.eye(1), np.array([[gain * (1.0 - pole)]]), np.zeros((1, 1)), step)


def _scalar(w: float, sensing: Sensing, weight: Discrete) -> tuple[Discrete, float]:
    """The loop of one direction: w^2/s^2, held and late, under the weight."""
    mass = StateSpace(*(np.array(part) for part in ([[0.0, 1.0], [0.0, 0.0]], [[0.0], [w]], [[w, 0.0]], [[0.0]])))
    late = series(delay(1, sensing.compute_delay, sensing.step), hold(mass, sensing.step))
    central, b_opt = coprime_controller(series(late, weight), FACTOR)
    return series(weight, central), b_opt
