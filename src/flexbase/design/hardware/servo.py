"""Loop shaping of the arm's joints alone, on a base that floats.

A controller that is made with the base's modes in its model resonates where the model does; at 1 % damping a base that
is 20 % off then stands in the wrong phase, and the changed robot is lost. This one has no base mode to be wrong about:
above its modes a base is as free as if it floated, and at them joint torques that lead the joints' angles take energy
out of it. On eight poses of a UR5e's pedestal, stripped of its damping and 0.3 to 4 times as stiff, all loops settle.

On a floating base the arm's inertia is F = Mhat - Map Mpp^-1 Mpa = L L^T, and tau = w L u, y = w L^T dq makes of all
its directions, the self-motion's too, one and the same w^2/s^2: one small scalar loop is designed, and used n times.
"""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.linear.coprime import coprime_controller
from flexbase.linear.discrete import Discrete, delay, hold, series, side_by_side, static
from flexbase.linear.second_order import StateSpace
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose

FACTOR = 1.03  # on gamma; 1.1 costs a hundredth or two of disk margin on a UR5e


def joint_servo(pose: Pose, sensing: Sensing, gains: Gains, scale: float, weight: Discrete) -> tuple[Discrete, float]:
    """A controller of the joints from tip error, joints and accelerations, of which it hears the joints; and its b_opt.

    Its stiffness per inertia at speed, w^2, is the mean of what scale Kp gives the task on a floating base.

    weight : on every joint, a scalar system; the controller has twice its states, and delay + 2, for each joint
    """
    n, k, m = pose.arm.n, pose.arm.k, pose.arm.m
    inertia = floating_inertia(pose)
    Jv = pose.J[:, m:]
    w = float(np.sqrt(scale * np.trace(gains.stiffness @ Jv @ np.linalg.solve(inertia, Jv.T)) / k))
    one, b_opt = _scalar(w, sensing, weight)
    L = np.asarray(w * np.linalg.cholesky(inertia))
    hears = static(np.hstack([np.zeros((n, k)), L.T, np.zeros((n, n))]), sensing.step)
    return series(series(hears, side_by_side(*[one] * n)), static(L, sensing.step)), b_opt


def floating_inertia(pose: Pose) -> Array:
    """Inertia that the arm's torques meet where nothing holds the base, shape (n, n)."""
    m = pose.arm.m
    M = pose.M
    return np.asarray(M[m:, m:] - M[m:, :m] @ np.linalg.solve(M[:m, :m], M[:m, m:]))


def _scalar(w: float, sensing: Sensing, weight: Discrete) -> tuple[Discrete, float]:
    """The loop of one direction: w^2/s^2, held and late, under the weight."""
    mass = StateSpace(*(np.array(part) for part in ([[0.0, 1.0], [0.0, 0.0]], [[0.0], [w]], [[w, 0.0]], [[0.0]])))
    late = series(delay(1, sensing.compute_delay, sensing.step), hold(mass, sensing.step))
    central, b_opt = coprime_controller(series(late, weight), FACTOR)
    return series(weight, central), b_opt
