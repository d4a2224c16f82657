"""The best posture for each of many targets at once: what a layout is judged by."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.inverse.arm_angles import arm_angles_of_many
from flexbase.dynamics.inverse.branches import NAMES
from flexbase.dynamics.inverse.six_joint_arm import six_joint_arm
from flexbase.study.postures.objective import Objective


class Standing(NamedTuple):
    """Postures for targets.

    joints : shape (T, n); values : the worst mode's, signed so that larger is better, -inf where there is none, (T,)
    branches : the branch that each stands on
    """

    joints: Array
    values: Array
    branches: tuple[str, ...]


def branches_of(objective: Objective, branch: str | None) -> tuple[str, ...]:
    """The branches that are compared: the one asked for, or all that the arm has."""
    arm = objective.arm
    if branch is not None:
        return (branch,)
    named = arm.k == 6 and arm.n == 6 and six_joint_arm(arm.mechanism, arm.base.equilibrium) is not None
    return NAMES if named else ("+", "-")


def stand(objective: Objective, targets: Array, branches: tuple[str, ...]) -> Standing:
    """The best posture of each target, shape (T, k), over some branches.

    A redundant arm climbs over its self-motion by the smooth minimum of the modes, continued from target to target.
    """
    arm = objective.arm
    best = Standing(np.zeros((len(targets), arm.n)), np.full(len(targets), -np.inf), ("",) * len(targets))
    for branch in branches:
        joints, reached = arm_angles_of_many(
            arm.mechanism, arm.task, arm.base.equilibrium, targets, branch, objective.smooth()
        )
        values = np.where(reached, objective.worst(joints), -np.inf)
        best = better_of(best, Standing(joints, values, (branch,) * len(targets)))
    return best


def better_of(one: Standing, other: Standing) -> Standing:
    """The better posture for each target."""
    gains = other.values > one.values
    return Standing(
        np.where(gains[:, None], other.joints, one.joints),
        np.where(gains, other.values, one.values),
        tuple(b if gain else a for a, b, gain in zip(one.branches, other.branches, gains, strict=True)),
    )
