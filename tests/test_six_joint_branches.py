"""Arms of six joints: every solution is found, has a name of its own, and is found again by it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import flexbase
from flexbase import InputError, Plant, Unreachable
from flexbase.dynamics.inverse.arm_angles import arm_angles_of_many
from flexbase.dynamics.inverse.branches import NAMES
from flexbase.dynamics.inverse.newton import TipProblem, solve_rows
from flexbase.dynamics.inverse.six_joint_arm import branch_signs, six_joint_arm
from flexbase.model.task import ROWS, Task
from systems.planar import planar
from systems.six_axes import ARMS, chain, crooked, six_axes, textbook
from systems.six_joint import six_joint


def turn(angles):
    """Differences of angles, modulo a full turn."""
    return np.abs(2.0 * np.sin(0.5 * np.asarray(angles)))


def bundled():
    """The UR5e from its file, all six rows, no gravity: its joint angles are those of the data sheet."""
    arm = flexbase.load("ur5e-pedestal").arm
    return Plant(dataclasses.replace(arm, task=Task(ROWS), gains=None, gravity=np.zeros(3)))


def typed():
    """The UR5e from its data sheet."""
    return six_joint(("px",), 6)


def bent(count, seed=3):
    """Random joints away from stretched elbows and wrists, where two solutions merge."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < count:
        q = rng.uniform(-np.pi, np.pi, 6)
        if min(abs(np.sin(q[2])), abs(np.sin(q[4]))) > 0.1:
            found.append(q)
    return np.array(found)


@pytest.mark.parametrize(
    ("make", "tolerance"),
    [(typed, 1e-8), pytest.param(bundled, 1e-6, marks=pytest.mark.slow)],
    ids=["data sheet", "URDF"],
)
def test_all_textbook_solutions_are_found_and_named_once(make, tolerance):
    """100 random poses: the solutions are those of Hawkins' closed form, each with its own name, and no others.

    The file rounds angles to 1e-10 and shoulders near their singular pose magnify that; at_tip repeats to 1e-9.
    """
    plant, counts = make(), []
    for q in bent(100):
        target, witness = plant.at(q).tip, np.array(textbook(chain(q)))
        assert max(np.abs(chain(row) - chain(q)).max() for row in witness) < 1e-10
        found = plant.solutions(target)
        counts.append(len(found))
        assert len({one.branch for one in found}) == len(found) == len(witness)
        for one in found:
            assert turn(witness - one.joints).max(axis=1).min() < tolerance
            again = plant.at_tip(target, one.branch).q[plant.arm.m :]
            assert turn(again - one.joints).max() < 1e-9
    assert set(counts) <= {2, 4, 6, 8}
    assert np.mean(counts) > 5.0


@pytest.mark.parametrize("arm", ARMS)
def test_factors_make_up_the_determinant(arm):
    """det J over shoulder, elbow and wrist factor is one number for the whole arm, to 1e-9: no factor is missing."""
    plant = six_axes(*ARMS[arm])
    six = six_joint_arm(plant.arm.mechanism, np.zeros(1))
    q = np.random.default_rng(1).uniform(-3.0, 3.0, (40, 6))
    signs = branch_signs(six, q)
    ratio = [np.linalg.det(plant.at(row).J[:, 1:]) / np.prod(sign) for row, sign in zip(q, signs, strict=True)]
    assert ratio == pytest.approx(np.full(40, ratio[0]), rel=1e-9)
    assert abs(ratio[0]) > 1e-3


@pytest.mark.parametrize("size", [0.0, pytest.param(1e-3, marks=pytest.mark.slow)], ids=["exact", "calibrated"])
@pytest.mark.parametrize("arm", ARMS)
def test_nothing_that_newton_finds_is_missing(arm, size):
    """Newton from 400 random starts finds no solution that is not listed, and the listed names differ.

    Also for an arm whose axes are off by 1e-3, as calibrated ones are: there the closed form only starts Newton.
    """
    plant = six_axes(*(crooked(*ARMS[arm], size) if size else ARMS[arm]))
    rng = np.random.default_rng(2)
    for q in bent(3):
        pose = plant.at(q)
        found = plant.solutions(pose.tip)
        assert len({one.branch for one in found}) == len(found)
        listed = np.array([one.joints for one in found])
        problem = TipProblem(plant.arm.mechanism, plant.arm.task, np.zeros(1))
        rows, errors = solve_rows(problem, rng.uniform(-3.1, 3.1, (400, 6)), pose.tip)
        rows = rows[errors < 1e-12]
        assert len(rows) > 20  # the witness sees something
        assert max(turn(listed - row).max(axis=1).min() for row in rows) < 1e-6
        assert turn(listed - q).max(axis=1).min() < 1e-6


def test_many_targets_on_a_named_branch():
    """A map's call on 2000 targets: every reached row is on the asked branch and at its target; one sign takes any."""
    plant = typed()
    arm, q = plant.arm, bent(2000)
    tips = np.array([plant.at(row).tip for row in q[:50]])
    names = [one for row in tips for one in [plant.solutions(row)]]
    for branch in ("+-+", "-++"):
        joints, reached = arm_angles_of_many(arm.mechanism, arm.task, np.zeros(1), tips, branch)
        assert reached.tolist() == [branch in {one.branch for one in found} for found in names]
        for row, tip in zip(joints[reached], tips[reached], strict=True):
            assert plant.at(row).tip == pytest.approx(tip, abs=1e-9)
    joints, reached = arm_angles_of_many(arm.mechanism, arm.task, np.zeros(1), tips, "-")
    assert reached.tolist() == [any(one.branch[1] == "-" for one in found) for found in names]
    assert (np.sin(joints[reached, 2]) <= 0.0).all()


def test_one_sign_is_the_elbows():
    """ "-" takes the first branch with that elbow, and near the nearest of them."""
    plant = typed()
    tip = plant.at([0.3, -1.2, -1.4, -1.5, -1.4, 0.2]).tip
    names = [one.branch for one in plant.solutions(tip)]
    assert names == sorted(names, key=NAMES.index)
    first = next(name for name in names if name[1] == "-")
    assert np.array_equal(plant.at_tip(tip, "-").q, plant.at_tip(tip, first).q)
    for one in plant.solutions(tip):
        assert plant.at_tip(tip, one.branch[1], near=one.joints + 0.01).q[1:] == pytest.approx(one.joints, abs=1e-9)


def test_another_branch_is_named_where_this_one_does_not_reach():
    plant = typed()
    for q in bent(100):
        names = [one.branch for one in plant.solutions(plant.at(q).tip)]
        if len(names) < 8:
            missing = next(name for name in NAMES if name not in names)
            with pytest.raises(
                Unreachable, match=f"on branch {missing[0]}.*but reached on .*{names[0][0]}".replace("+", r"\+")
            ):
                plant.at_tip(plant.at(q).tip, missing)
            return
    pytest.fail("every pose has eight solutions")


@pytest.mark.parametrize(
    ("plant", "reason"),
    [
        (planar([0.2, 0.3, 0.25, 0.2], rows=("x", "y", "rz")), "six revolute joints"),
        (planar([0.2, 0.3, 0.25]), "six revolute joints"),
        (six_axes(*crooked(*ARMS["industrial"], 0.2)), "nor do axes 4, 5, 6 meet"),
    ],
    ids=["3R", "2R", "general 6R"],
)
def test_three_signs_are_refused_where_they_mean_nothing(plant, reason):
    with pytest.raises(InputError, match=reason):
        plant.at_tip(plant.at(np.full(plant.arm.n, 0.4)).tip, "+-+")


def test_a_general_arm_still_has_its_elbow():
    """Six joints without a wrist centre: Newton from many starts, named by the elbow's sign."""
    plant = six_axes(*crooked(*ARMS["industrial"], 0.2))
    tip = plant.at([0.3, 0.4, 0.8, 0.5, 0.9, 0.2]).tip
    found = plant.solutions(tip)
    assert len(found) >= 2
    assert {one.branch for one in found} <= {"+", "-"}
    assert all(plant.at(one.joints).tip == pytest.approx(tip, abs=1e-9) for one in found)


def test_solutions_of_two_joints_and_of_redundant_arms(paper):
    both = paper.solutions([0.33, -0.25])
    assert [one.branch for one in both] == ["+", "-"]
    assert np.array_equal(both[0].joints, paper.at_tip([0.33, -0.25]).q[1:])
    assert paper.solutions([5.0, 0.0]) == ()
    with pytest.raises(InputError, match="infinitely many"):
        flexbase.load("ur5e-pedestal").solutions([0.5, 0.2, 0.9])


def test_three_signs_also_bound_a_redundant_arm():
    """The UR5e with three rows: the best posture on the asked branch lies on it."""
    plant = flexbase.load("ur5e-pedestal")
    six = six_joint_arm(plant.arm.mechanism, plant.arm.base.equilibrium)
    for branch in ("+++", "-+-", "+--"):
        signs = branch_signs(six, plant.at_tip([0.5, 0.2, 0.9], branch).q[None, plant.arm.m :])[0]
        assert "".join("+" if sign >= 0.0 else "-" for sign in signs) == branch
