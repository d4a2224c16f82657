"""Baseline: linear-quadratic Gaussian control on tip error and joints, on the delayed plant."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np

from flexbase.checks import Array, positive_number
from flexbase.errors import Infeasible, Unsolvable
from flexbase.linear.discrete import riccati
from flexbase.linear.discrete.system import Discrete
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.requests import Says
from flexbase.sampled.controller import SampledController
from flexbase.synthesis.registry import hardware_method
from flexbase.synthesis.search.shaping import design_plant, task_shape

JOINT_WEIGHT = 0.5  # of the joints beside the tip error, as in loop shaping
NOISE = 0.01  # variance of the measurements over that of the force disturbance, both weighted by Kp

Noise = Annotated[float, Says("variance of the measurements over that of the force")]


class Regulator(NamedTuple):
    """State feedback u = -K x and filter x = x_predicted + L (y - C x_predicted)."""

    K: Array
    L: Array


@hardware_method("lqg", "the textbook optimum; stiff and noisy, with little margin at the sensors")
def lqg(pose: Pose, sensing: Sensing, gains: Gains, *, noise: Noise = NOISE) -> SampledController:
    """Least mean of e^T Kp e + f^T Kp^-1 f under white force disturbance, tau = Jv^T f, on the sampled plant.

    The disturbance has covariance Kp and enters where the force does; the measurements of e and of half of Jv dq_a have
    noise of covariance `noise` Kp^-1. A redundant arm's self-motion is weighted as in `task_shape`.

    Raises Infeasible where a Riccati equation has no stabilising solution.
    """
    positive_number("noise", noise, "1")
    shape = task_shape(pose, gains, 1.0, JOINT_WEIGHT)
    plant = shape.around(design_plant(pose, sensing))
    k, n = pose.arm.k, pose.arm.n
    judged = plant.C.copy()
    judged[k : 2 * k] = 0.0  # the task wants the tip at rest, and the self-motion; joints only inform
    try:
        found = regulator(plant, judged.T @ judged, np.eye(n), noise * np.eye(len(plant.C)))
    except Unsolvable as fault:
        raise Infeasible(f"{pose.plant.name}: LQG has no stabilising solution at this pose ({fault}).") from fault
    notes = {"noise": noise, "joint_weight": JOINT_WEIGHT, "order": plant.order}
    return SampledController("lqg", pose, sensing, shape.unfold(observer(plant, found)), None, notes)


def regulator(plant: Discrete, Q: Array, R: Array, V: Array) -> Regulator:
    """Optimal feedback for the cost x^T Q x + u^T R u, and filter for unit noise at the inputs and V at the outputs."""
    A, B, C = plant.A, plant.B, plant.C
    X = riccati.discrete(A, B, Q, R)
    P = riccati.discrete(A.T, C.T, B @ B.T, V)
    feedback, filtered = np.linalg.solve(R + B.T @ X @ B, B.T @ X @ A), np.linalg.solve(V + C @ P @ C.T, C @ P).T
    return Regulator(np.asarray(feedback), np.asarray(filtered))


def observer(plant: Discrete, found: Regulator) -> Discrete:
    """u from y, the present y included. Assumes a plant without direct throughput."""
    moved, corrected = plant.A - plant.B @ found.K, np.eye(plant.order) - found.L @ plant.C
    return Discrete(moved @ corrected, moved @ found.L, -found.K @ corrected, -found.K @ found.L, plant.step)
