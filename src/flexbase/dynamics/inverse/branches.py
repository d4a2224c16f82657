"""Branches of the inverse kinematics: what their names mean, and which joints lie on one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.dynamics.inverse.six_joint_arm import SixJointArm, branch_signs, six_joint_arm
from flexbase.errors import InputError
from flexbase.model.mechanism import Mechanism
from flexbase.model.parts import base_first

NAMES = tuple(a + b + c for a in "+-" for b in "+-" for c in "+-")  # shoulder, elbow, wrist
Inside = Callable[[Array], NDArray[np.bool_]]


def elbow_of(n: int) -> int | None:
    """Which arm joint is the elbow: the fourth of seven, the third of six, the second of fewer, none of one."""
    return None if n < 2 else {6: 2, 7: 3}.get(n, 1)


def inside_branch(mechanism: Mechanism, base_rest: Array, branch: str) -> Inside:
    """A function that says which rows of arm joints, shape (S, n), lie on a branch, shape (S,).

    One sign is the elbow's: of its factor of det J where the arm is a `SixJointArm`, else of the sine of its joint;
    every row lies on it where there is no elbow, or it slides. Three signs are shoulder, elbow and wrist of
    `branch_signs`. Zero counts as "+". Raises InputError where three signs are given and the arm has no such names.
    """
    six = six_joint_arm(mechanism, base_rest)
    if len(branch) == 3:
        if six is None:
            why = _why_unnamed(mechanism, base_rest)
            raise InputError(f'branch: "{branch}" has no meaning here, because {why}. Give + or -.')
        return lambda joints: np.asarray(((branch_signs(six, joints) >= 0.0) == _signs(branch)).all(axis=1))
    plus = branch == "+"
    if six is not None:
        return lambda joints: np.asarray((branch_signs(six, joints)[:, 1] >= 0.0) == plus)
    kinds = base_first(len(base_rest), mechanism.N).arm(mechanism.joint_types)
    elbow = elbow_of(len(kinds))
    if elbow is None or kinds[elbow] != "revolute":
        return lambda joints: np.ones(len(joints), dtype=bool)
    return lambda joints: np.asarray((np.sin(joints[:, elbow]) >= 0.0) == plus)


def places(arm: SixJointArm, joints: Array) -> NDArray[np.int_]:
    """The place in NAMES of each row of joints (S, 6)."""
    return np.asarray((branch_signs(arm, joints) < 0.0) @ np.array([4, 2, 1]))


def matching(branch: str) -> list[int]:
    """The places in NAMES that a branch of one or three signs allows, in order."""
    return [i for i, name in enumerate(NAMES) if name == branch or (len(branch) == 1 and name[1] == branch)]


def _signs(branch: str) -> NDArray[np.bool_]:
    return np.array([sign == "+" for sign in branch])


def _why_unnamed(mechanism: Mechanism, base_rest: Array) -> str:
    kinds = base_first(len(base_rest), mechanism.N).arm(mechanism.joint_types)
    if len(kinds) != 6 or "prismatic" in kinds:
        return f"shoulder, elbow and wrist are named on six revolute joints, and the arm has {', '.join(kinds)}"
    return (
        "neither are axes 2, 3, 4 parallel with axes 5, 6 meeting, nor do axes 4, 5, 6 meet in a point "
        "(with axes 2, 3 parallel or axes 1, 2 meeting)"
    )
