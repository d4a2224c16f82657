"""The plant as loop shaping sees it: task and self-motion forces in, weighted tip error and joints out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from flexbase.checks import Array, is_definite
from flexbase.control.null_space import self_motions
from flexbase.errors import Infeasible
from flexbase.linear.discrete.system import Discrete, series, side_by_side, static
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.sampled.plant import sampled_plant


@dataclass(frozen=True, eq=False)
class Shape:
    """Weights around a plant: what enters it and what is seen of it.

    into : torques of the shaped inputs, shape (n, n)
    seen : shaped outputs of tip error, joints and accelerations, shape (outputs, k + 2n)
    lag : filter on every shaped output, or None
    """

    into: Array
    seen: Array
    lag: Discrete | None = None

    def around(self, plant: Discrete) -> Discrete:
        """The shaped plant."""
        return series(series(static(self.into, plant.step), plant), self._weight(plant.step))

    def unfold(self, controller: Discrete) -> Discrete:
        """A controller of the shaped plant as one of the plant."""
        step = controller.step
        return series(series(self._weight(step), controller), static(self.into, step))

    def _weight(self, step: float) -> Discrete:
        seen = static(self.seen, step)
        return seen if self.lag is None else series(seen, side_by_side(*[self.lag] * len(self.seen)))


def design_plant(pose: Pose, sensing: Sensing) -> Discrete:
    """The sampled plant without sensors of acceleration; a slower task sensor's hold counts as its mean delay."""
    plain = replace(sensing, acceleration="encoders", task_every=1, task_delay=sensing.mean_task_delay)
    n, k = pose.arm.n, pose.arm.k
    return sampled_plant(pose, plain).select(list(range(k + 2 * n)), list(range(n)))


def check_stiff(pose: Pose, gains: Gains) -> None:
    """Raises Infeasible where the task's stiffness leaves a direction of the tip without weight."""
    if not is_definite(gains.stiffness):
        raise Infeasible(
            f"{pose.plant.name}: the task stiffness is zero in some direction, where loop shaping has no weight then. "
            "Give a positive definite one."
        )


def task_shape(pose: Pose, gains: Gains, scale: float, joint_weight: float, lag: Discrete | None = None) -> Shape:
    """Inputs f, tau = Jv^T f; outputs scale Kp e and joint_weight scale Kp Jv dq_a.  [theory §10]

    Inputs and outputs each take the root of scale Kp, so that rows of different units weigh alike.

    A redundant arm's self-motion gets an input and an output of its own, W dq_a with W Mhat^-1 Jv^T = 0, so that the
    task cannot lose it: stiffness per inertia the mean of the task's. [theory §7] Raises Infeasible.
    """
    n, k = pose.arm.n, pose.arm.k
    Jv, inertia = pose.Jv, pose.Mhat
    check_stiff(pose, gains)
    root = np.linalg.cholesky(scale * gains.stiffness)
    W = np.zeros((0, n))
    if n > k:
        mobility = root.T @ Jv @ np.linalg.solve(inertia, Jv.T) @ root
        W = np.sqrt(np.trace(mobility) / k) * (self_motions(pose, np.zeros((n, n))).T @ inertia)
    blind = np.zeros((k, n))
    rows = [np.hstack([root.T, blind, blind])]
    if joint_weight > 0.0:
        rows.append(np.hstack([np.zeros((k, k)), joint_weight * root.T @ Jv, blind]))
    if n > k:
        rows.append(np.hstack([np.zeros((n - k, k)), W, np.zeros((n - k, n))]))
    return Shape(np.hstack([Jv.T @ root, W.T]), np.vstack(rows), lag)


class Weight(NamedTuple):
    """A gain over frequency: `ratio` at rest, 1 above `turn`, `lead` above `corner` [rad/s]."""

    ratio: float = 1.0
    turn: float = 1.0
    lead: float = 1.0
    corner: float = 100.0

    def sampled(self, step: float) -> Discrete:
        """(s + turn)/(s + turn/ratio) times lead (s + corner/lead)/(s + corner), without what is 1."""
        whole = static(np.array([[self.lead]]), step)
        if self.ratio != 1.0:
            whole = series(slow_gain(self.ratio, self.turn / self.ratio, step), whole)
        if self.lead != 1.0:
            whole = series(whole, slow_gain(1.0 / self.lead, self.corner, step))
        return whole


def slow_gain(ratio: float, corner: float, step: float) -> Discrete:
    """(s + ratio corner)/(s + corner), poles and zeros matched: `ratio` at rest, 1 at speed; corner [rad/s]."""
    pole, zero = np.exp(-corner * step), np.exp(-ratio * corner * step)
    gain = ratio * (1.0 - pole) / (1.0 - zero)
    direct = np.array([[gain]])
    return Discrete(np.array([[pole]]), np.eye(1), direct * (pole - zero), direct, step)
