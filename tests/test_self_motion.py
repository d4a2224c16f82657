"""The best posture over the self-motion of redundant arms: against brute force, stationary, and continuous in maps."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import flexbase
from flexbase import Plant
from flexbase.dynamics.inverse.arm_angles import arm_angles_of_many
from flexbase.dynamics.inverse.newton import TipProblem, rotation_vector_slope
from flexbase.dynamics.inverse.posture_criteria import isotropy
from flexbase.dynamics.inverse.self_motion import best_posture
from flexbase.model.task import Task
from systems.planar import planar

LENGTHS = [0.1, 0.3, 0.25, 0.2]  # three joints for x and y: one turn of freedom
ROBOTS = ["ur5e-pedestal", "panda-pedestal", "iiwa-platform"]


def by_differences(value, step=1e-5):
    """A criterion from values alone: central differences of rows (S, n) -> (S,). Error of the gradient: step^2.

    step : rad or m, the same for all joints
    """

    def criterion(joints):
        n = joints.shape[1]
        moves = step * np.concatenate([np.zeros((1, n)), np.eye(n), -np.eye(n)])
        rows = (joints + moves[:, None, :]).reshape(-1, n)
        values = np.asarray(value(rows)).reshape(2 * n + 1, len(joints))
        return values[0], ((values[1 : n + 1] - values[n + 1 :]) / (2.0 * step)).T

    return criterion


def parts(plant):
    arm = plant.arm
    return arm.mechanism, arm.task, arm.base.equilibrium


def brute_force(target):
    """The most isotropic posture of the three links, elbow "+", by trying 20000 angles of the first link."""
    first = np.linspace(-np.pi, np.pi, 20001)
    a, b, c = LENGTHS[1:]
    x, y = target[0] - LENGTHS[0] - a * np.cos(first), target[1] - a * np.sin(first)
    best = -np.inf
    cosine = (x * x + y * y - b * b - c * c) / (2.0 * b * c)
    reached = np.abs(cosine) < 1.0
    for side in (1.0, -1.0):
        bend = side * np.arccos(cosine[reached])
        second = np.arctan2(y[reached], x[reached]) - np.arctan2(c * np.sin(bend), b + c * np.cos(bend))
        one = first[reached]
        right = np.sin(second - one) >= 0.0
        tip = np.array([x[reached] + a * np.cos(one), y[reached] + a * np.sin(one)])
        joints = [np.zeros((2, one.size)), np.array([a * np.cos(one), a * np.sin(one)])]
        joints.append(joints[1] + [b * np.cos(second), b * np.sin(second)])
        J = np.array([[-(tip - p)[1], (tip - p)[0]] for p in joints])  # (joint, row, sample)
        gram = np.einsum("jrs,jqs->srq", J, J)
        det, trace = np.linalg.det(gram), np.trace(gram, axis1=1, axis2=2)
        value = 0.5 * np.log(np.maximum(det, 1e-300)) - np.log(0.5 * trace)
        best = max(best, value[right].max(initial=-np.inf))
    return best


@pytest.mark.parametrize("target", [[0.45, 0.2], [0.2, -0.4], [-0.3, 0.1], [0.7, 0.2], [0.15, 0.1]])
def test_no_sampled_posture_is_better(target):
    """Brute force in steps of 3e-4 rad misses the optimum by 1e-7 at most; ours may not be worse, nor much better."""
    plant = planar(LENGTHS)
    found = best_posture(*parts(plant), np.array(target), isotropy(*parts(plant)))
    assert found.value == pytest.approx(brute_force(target), abs=1e-6)
    assert found.value >= brute_force(target) - 1e-9
    pose = plant.at_tip(target)
    assert pose.q[1:] == pytest.approx(found.joints, abs=1e-9)
    assert pose.tip == pytest.approx(target, abs=1e-10)


@pytest.mark.parametrize("robot", ROBOTS)
def test_gradient_of_isotropy(robot):
    """Against central differences of the value, step 1e-5: truncation and rounding stay below 1e-7 of the largest."""
    plant = flexbase.load(robot)
    criterion = isotropy(*parts(plant))
    joints = np.random.default_rng(0).uniform(-2.0, 2.0, (20, plant.arm.n))
    value, gradient = criterion(joints)
    witness = by_differences(lambda rows: criterion(rows)[0])(joints)
    assert np.array_equal(value, witness[0])
    assert gradient == pytest.approx(witness[1], abs=1e-7 * np.abs(gradient).max())


@pytest.mark.parametrize("robot", ROBOTS)
def test_at_tip_is_stationary_along_the_self_motion(robot):
    """The gradient of the isotropy has no part in the null space of Jv: 1e-6 of what it is at random poses.

    Branch "-", because the best posture of the Panda on "+" lies at the edge of the branch, where the slope stays.
    """
    plant = flexbase.load(robot)
    criterion, m = isotropy(*parts(plant)), plant.arm.m
    for tip in ([0.5, 0.2, 1.0], [-0.3, 0.4, 1.1]):
        pose = plant.at_tip(tip, "-")
        null = np.linalg.svd(pose.J[:, m:])[2][plant.arm.k :]
        assert null @ criterion(pose.q[None, m:])[1][0] == pytest.approx(np.zeros(len(null)), abs=1e-6)
        assert pose.tip == pytest.approx(tip, abs=1e-10)


def test_any_criterion_may_be_asked_for():
    """The posture nearest to given joints that already reach the target: those joints, from values alone.

    Differences in steps of 1e-5 leave the gradient right to 1e-10, so the optimum to 1e-6.
    """
    plant = flexbase.load("panda-pedestal")
    wanted = np.array([0.3, 0.4, -0.2, 1.2, 0.5, 1.1, 0.2])
    criterion = by_differences(lambda rows: -((rows - wanted) ** 2).sum(axis=1))
    found = best_posture(*parts(plant), plant.at(wanted).tip, criterion, starts=wanted[None] + 0.1)
    assert found.joints == pytest.approx(wanted, abs=1e-6)
    assert found.value == pytest.approx(0.0, abs=1e-10)


def test_out_of_reach_is_none():
    plant = planar(LENGTHS)
    assert best_posture(*parts(plant), np.array([2.0, 0.0]), isotropy(*parts(plant))) is None


def test_a_map_holds_the_best_posture_in_every_cell():
    """21 x 21 cells: each value is brute force's, neighbours differ by a jump in few places only."""
    plant = planar(LENGTHS)
    x, y = np.meshgrid(np.linspace(-0.7, 0.9, 21), np.linspace(-0.8, 0.8, 21))
    targets = np.column_stack([x.ravel(), y.ravel()])
    joints, reached = arm_angles_of_many(*parts(plant), targets, "+")
    radius = np.hypot(targets[:, 0] - 0.1, targets[:, 1])
    assert reached.tolist() == (radius < 0.75).tolist()
    value = isotropy(*parts(plant))(joints[reached])[0]
    witness = np.array([brute_force(target) for target in targets[reached]])
    assert value == pytest.approx(witness, abs=2e-6)
    for row, target in zip(joints[reached][::40], targets[reached][::40], strict=True):
        assert plant.at(row).tip == pytest.approx(target, abs=1e-10)


def test_a_map_agrees_with_single_poses():
    """UR5e, 5 x 5 cells: as isotropic as a search in each cell finds it, to 1e-5 in most and to 1e-3 in all.

    The map searches globally in a few cells only; the others learn from their neighbours.
    """
    plant = flexbase.load("ur5e-pedestal")
    x, y = np.meshgrid(np.linspace(0.2, 0.7, 5), np.linspace(-0.4, 0.4, 5))
    targets = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, 1.1)])
    joints, reached = arm_angles_of_many(*parts(plant), targets, "+")
    assert reached.all()
    criterion = isotropy(*parts(plant))
    single = np.array([best_posture(*parts(plant), target, criterion).value for target in targets])
    lacking = single - criterion(joints)[0]
    assert lacking.max() < 1e-3
    assert np.mean(lacking < 1e-5) > 0.8


def test_slope_of_the_rotation_vector():
    """Against central differences of log(exp(h w) R), step 1e-6, also near zero: 1e-8."""
    from scipy.spatial.transform import Rotation

    for vector in ([0.3, -1.2, 0.9], [1e-5, 2e-5, 0.0], [2.0, 2.0, 0.5]):
        R, h = Rotation.from_rotvec(vector), 1e-6
        slope = [
            ((Rotation.from_rotvec(h * e) * R).as_rotvec() - (Rotation.from_rotvec(-h * e) * R).as_rotvec()) / (2 * h)
            for e in np.eye(3)
        ]
        assert rotation_vector_slope(np.array(vector)) == pytest.approx(np.array(slope).T, abs=1e-8)


@pytest.mark.parametrize("rows", [("x", "y", "z", "rz"), ("rx", "ry"), ("x", "z", "rx", "ry"), ("ry",)], ids=" ".join)
def test_open_rotation_rows_are_met_and_the_others_free(rows):
    """One or two rotation rows on an arm that turns freely: the pose's own coordinates are the target, to 1e-9."""
    arm = flexbase.load("ur5e-pedestal").arm
    plant = Plant(dataclasses.replace(arm, task=Task(rows), gains=None))
    assert TipProblem(*parts(plant)).open_rotation
    rng = np.random.default_rng(4)
    for _ in range(4):
        known = plant.at(np.array([0.3, -1.2, 1.4, -1.5, -1.4, 0.2]) + 0.3 * rng.normal(size=6))
        assert plant.at_tip(known.tip).tip == pytest.approx(known.tip, abs=1e-9)
        near = plant.at_tip(known.tip, near=known.q[arm.m :])
        assert near.q[arm.m :] == pytest.approx(known.q[arm.m :], abs=1e-9)
