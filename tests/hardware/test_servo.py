"""The joints alone on a floating base: one scalar loop in every direction, and no base mode that could be wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.model.sensing import Sensing
from flexbase.plant import Plant
from flexbase.sampled.closed import close_loop, loop_gain, tip_correction, tip_stiffness
from flexbase.sampled.controller import SampledController
from flexbase.study.random_poses import random_poses
from flexbase.synthesis.search.servo import Slow, joint_servo
from flexbase.synthesis.search.shaping import Weight

PLAIN, SLOW = Weight(), Slow(10.0, 30.0)


def servo_at(pose: fb.Pose, sensing: Sensing, weight: Weight = PLAIN, slow: Slow | None = SLOW) -> SampledController:
    gains = pose.arm.gains
    assert gains is not None
    system, _ = joint_servo(pose, sensing, gains, 1.0, weight.sampled(sensing.step), slow)
    return SampledController("servo", pose, sensing, system)


@pytest.mark.parametrize("robot", ["ueda2003", "ur5e-pedestal", "panda-platform"])
def test_floating_inertia_is_what_torques_meet(robot: str) -> None:
    """The arm's block of M^-1, inverted: what the torques accelerate, base and all."""
    pose = random_poses(fb.load(robot), 1, 1)[0]
    m = pose.arm.m
    assert pose.Ms == pytest.approx(np.linalg.inv(np.linalg.inv(pose.M)[m:, m:]), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("delay", [0, 1, 2])
def test_directions_are_one_scalar_loop(delay: int) -> None:
    """Ten times above the base's 110 rad/s all six eigenvalues of the loop gain are one, within 3 %."""
    pose = random_poses(fb.load("ur5e-pedestal"), 1, 2)[0]
    loop = loop_gain(pose, servo_at(pose, Sensing(compute_delay=delay)))
    eigenvalues = np.linalg.eigvals(loop.transfer_function(np.array([1100.0]))[0])
    assert np.abs(eigenvalues / eigenvalues.mean() - 1.0).max() < 0.03


def test_order_and_what_it_hears() -> None:
    """As the docstring counts the states; accelerations are not heard, the tip error only by the slow loop."""
    pose = random_poses(fb.load("ur5e-pedestal"), 1, 2)[0]
    for weight, states in ((PLAIN, 0), (Weight(10.0, 20.0), 1), (Weight(20.0, 5.0, 3.0), 2)):
        for slow in (SLOW, None):
            system = servo_at(pose, Sensing(), weight, slow).system
            assert system.order == 6 * (2 * states + 1 + 2) + (6 if slow else 0)
            response = system.transfer_function(np.array([1.0]))[0]
            assert np.any(response != 0.0, axis=0).tolist() == [slow is not None] * 3 + [True] * 6 + [False] * 6


@pytest.mark.parametrize("robot", ["ueda2003", "ur5e-pedestal"])
def test_tip_errors_are_taken_away(robot: str) -> None:
    """Ten parts of eleven of an error that the joints do not show; none without the slow loop, which also stiffens."""
    pose = random_poses(fb.load(robot), 2, 0)[1]
    with_it, alone = (servo_at(pose, Sensing(), slow=slow) for slow in (SLOW, None))
    assert tip_correction(pose, with_it) == pytest.approx(10.0 / 11.0, rel=1e-2)
    assert tip_correction(pose, alone) == pytest.approx(0.0, abs=1e-9)
    assert tip_stiffness(pose, with_it) == pytest.approx(11.0 * tip_stiffness(pose, alone), rel=0.02)


@pytest.mark.parametrize("stiffness", [0.3, 0.6, 1.0, 2.0, 4.0])
def test_undamped_bases_of_any_stiffness_settle(stiffness: float) -> None:
    """Its own joints are all that damps: five poses on a pedestal without damping, which is not as stiff as assumed."""
    for pose in random_poses(fb.load("ur5e-pedestal"), 5, 0):
        base = pose.arm.base
        changed = replace(base, stiffness=stiffness * base.stiffness, damping=0.0 * base.damping)
        there = Plant(replace(pose.arm, base=changed)).at(pose.q)
        assert close_loop(there, servo_at(pose, Sensing())).radius < 1.0


def test_weight_is_its_three_gains() -> None:
    """The ratio at rest, 1 between, the lead at speed: within 5 % a decade from the corners."""
    weight = Weight(20.0, 0.05, 3.0, 100.0).sampled(1e-4)
    gain = np.abs(weight.transfer_function(np.array([1e-7, 1.0, 3000.0]))[:, 0, 0])
    assert gain == pytest.approx([20.0, 1.0, 3.0], rel=0.05)


def test_rows_of_different_units_are_corrected_alike() -> None:
    """A SCARA's rotation is moved far more easily than its translations: of each ten parts of eleven are taken away."""
    pose = random_poses(fb.load("scara"), 1, 0)[0]
    assert tip_correction(pose, servo_at(pose, Sensing(), slow=SLOW)) == pytest.approx(10.0 / 11.0, abs=0.01)
