"""Inverse kinematics: the tip lands on its target, on the asked branch, or the answer is a plain no."""

from __future__ import annotations

import numpy as np
import pytest

from flexbase import InputError, SingularArm, Unreachable
from systems.oracle import rigid_bodies
from systems.planar import planar

ARMS = {
    "2R": {"lengths": [0.2, 0.3, 0.25]},
    "2R, rows y x": {"lengths": [0.2, 0.3, 0.25], "rows": ("y", "x")},
    "3R with angle": {"lengths": [0.2, 0.3, 0.25, 0.2], "rows": ("x", "y", "rz")},
    "4R redundant": {"lengths": [0.1, 0.3, 0.25, 0.2, 0.15]},
    "3R redundant on 2": {"lengths": [0.1, 0.1, 0.3, 0.25, 0.2], "m": 2},
    "PP": {"lengths": [0.1, 0.0, 0.1], "slide": (1, 2), "axes": {1: (1.0, 0.0), 2: (0.3, 1.0)}},
    "RP": {"lengths": [0.1, 0.2, 0.2], "slide": (2,)},
    "PR": {"lengths": [0.1, 0.2, 0.4], "slide": (1,), "axes": {1: (1.0, 0.2)}},
    "PRR with angle": {"lengths": [0.1, 0.1, 0.3, 0.2], "slide": (1,), "rows": ("x", "y", "rz")},
    "1R": {"lengths": [0.2, 0.4], "rows": ("rz",)},
}


def place(pose):
    """x, y, rz of the tool by Pinocchio."""
    rotation, position = rigid_bodies(pose).tool_pose(pose.q)
    return {"x": position[0], "y": position[1], "rz": np.arctan2(rotation[1, 0], rotation[0, 0])}


@pytest.mark.parametrize("arm", ARMS)
def test_tip_lands_on_random_targets(arm):
    """Targets that some configuration reaches: at_tip(target) has its tip there, to 1e-10 m and rad.

    The witness is Pinocchio; Newton stops at 1e-11 of the arm's reach. Both branches, wherever they exist.
    """
    plant, rng = planar(**ARMS[arm]), np.random.default_rng(5)
    elbow = plant.arm.n > 1 and plant.arm.mechanism.joint_types[plant.arm.m + 1] == "revolute"
    for _ in range(12):
        drawn = rng.uniform(-2.6, 2.6, plant.arm.n)
        sliding = np.array(plant.arm.mechanism.joint_types[plant.arm.m :]) == "prismatic"
        drawn[sliding] = rng.uniform(0.05, 0.6, sliding.sum())
        if elbow and abs(np.sin(drawn[1])) < 0.1:
            continue  # too near the arm's own singularity for a fair target
        known = plant.at(drawn)
        branch = "+" if not elbow or np.sin(drawn[1]) >= 0.0 else "-"
        pose = plant.at_tip(known.tip, branch=branch)
        found, wanted = place(pose), place(known)
        rows = plant.arm.task.rows
        assert [found[row] for row in rows] == pytest.approx([wanted[row] for row in rows], abs=1e-10)
        assert pose.tip == pytest.approx(known.tip, abs=1e-10)
        if elbow:
            assert (np.sin(pose.q[plant.arm.m + 1]) >= 0.0) == (branch == "+")
        assert np.array_equal(pose.q[: plant.arm.m], plant.arm.base.equilibrium)


def test_both_branches_of_two_joints(paper):
    """The same tip with the elbow either way: mirror images about the line to the shoulder."""
    plus, minus = (paper.at_tip([0.33, -0.25], branch=branch) for branch in "+-")
    assert plus.tip == pytest.approx(minus.tip, abs=1e-13)
    assert plus.q[2] == pytest.approx(-minus.q[2], rel=1e-12)
    assert 0.0 < plus.q[2] < np.pi


def test_default_branch_is_the_projects(paper):
    """branch = "+" in ueda2003: 0 < q3 < pi without being asked."""
    assert np.array_equal(paper.at_tip([0.33, -0.25]).q, paper.at_tip([0.33, -0.25], branch="+").q)


def test_nearest_of_several_solutions_is_taken():
    """A redundant arm reaches a tip in many ways: a start that already does is kept, to rounding."""
    plant = planar([0.1, 0.3, 0.25, 0.2, 0.15])
    for seed in range(5):
        near = np.random.default_rng(seed).uniform(0.3, 1.2, 4)
        known = plant.at(near)
        assert plant.at_tip(known.tip, near=near).q[1:] == pytest.approx(near, abs=1e-9)


@pytest.mark.parametrize(
    ("arm", "target", "missing"),
    [
        ("2R", [0.76, 0.0], "0.01 m"),
        ("2R", [0.2, 0.0], "0.05 m"),
        ("2R", [-2.0, 0.0], "1.65 m"),
        ("4R redundant", [1.2, 0.0], "0.2 m"),
    ],
)
def test_out_of_reach_says_by_how_much(arm, target, missing):
    """Beyond the reach, or inside the hole: Unreachable with the distance that is missing, a closed form here."""
    with pytest.raises(Unreachable, match=f"out of reach.*by {missing}"):
        planar(**ARMS[arm]).at_tip(target)


@pytest.mark.parametrize("joints", [[0.4, 0.0], [0.4, np.pi], [-2.0, 1e-10]])
def test_stretched_or_folded_arm_is_singular(paper, joints):
    """q3 = 0 or pi: Jv loses rank; the singular values come with the message."""
    with pytest.raises(SingularArm, match="singular values of Jv"):
        paper.at(joints)


def test_full_reach_is_singular_not_unreachable(paper):
    """The outermost tip is reached, by a singular arm: either word is a plain no, and nothing else comes out."""
    with pytest.raises((SingularArm, Unreachable)):
        paper.at_tip([0.75, 0.0])


@pytest.mark.parametrize("axis", [(1.0, 0.0), (1.0, 1.0), (0.3, -0.7)])
@pytest.mark.parametrize("target", [[0.5, 0.3], [9.0, 9.0], [400.0, 1.0]])
def test_parallel_sliders_are_refused(axis, target):
    """Two prismatic joints along one line never reach off it, and are singular on it: no other error comes out."""
    plant = planar([0.1, 0.0, 0.1], slide=(1, 2), axes={1: axis, 2: axis})
    with pytest.raises((SingularArm, Unreachable)):
        plant.at_tip(target)


@pytest.mark.parametrize("lengths", [[0.2, 0.3, 0.0], [0.2, 0.0, 0.3], [0.2, 0.0, 0.0]])
def test_links_without_length_are_refused(lengths):
    """A forearm or upper arm of length zero leaves the arm singular everywhere: a plain no, without a warning."""
    plant = planar(lengths)
    for target in ([0.45, 0.2], [0.2, 0.3], [0.2, 0.0]):
        with pytest.raises((SingularArm, Unreachable)):
            plant.at_tip(target)


@pytest.mark.parametrize(
    ("target", "message"),
    [
        ([0.3], "tip: 1 values? given, 2 needed"),
        ([0.3, 0.1, 0.0], "tip: 3 values given, 2 needed"),
        ([[0.3, 0.1]], r"tip: an array of shape \(1, 2\)"),
        (["a", "b"], "not an array of numbers"),
        ([np.nan, 0.1], "not finite"),
        ([np.inf, 0.1], "not finite"),
    ],
)
def test_wrong_targets_are_refused(paper, target, message):
    """Count, shape, type and finiteness of a target: one InputError each."""
    with pytest.raises(InputError, match=message):
        paper.at_tip(target)


def test_wrong_branch_and_near_are_refused(paper):
    """A branch that is neither sign, a start of the wrong length."""
    with pytest.raises(InputError, match='"up" is unknown'):
        paper.at_tip([0.33, -0.25], branch="up")
    with pytest.raises(InputError, match="near: 3 values given, 2 needed"):
        paper.at_tip([0.33, -0.25], near=[0.0, 0.0, 0.0])


@pytest.mark.parametrize("count", [1, 4])
def test_wrong_number_of_joints_is_refused(paper, count):
    """at takes n or N joints, and names them."""
    with pytest.raises(InputError, match=rf"{count} values? given, 2 .* or 3 .* needed: q1, q2, q3"):
        paper.at(np.zeros(count))


def test_all_joints_set_the_bases_equilibrium(paper):
    """With N joints given, the base values are where its springs rest; with n, the project's."""
    turned, straight = paper.at([0.2, 0.4, 0.9]), paper.at([0.4, 0.9])
    assert turned.equilibrium.tolist() == [0.2]
    assert straight.equilibrium.tolist() == [0.0]
    c, s = np.cos(0.2), np.sin(0.2)
    assert turned.tip == pytest.approx(np.array([[c, -s], [s, c]]) @ straight.tip, abs=1e-14)
