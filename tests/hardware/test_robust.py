"""The method for changed robots: beats theory §10's table, and its parts do what they say."""

from __future__ import annotations

import numpy as np
import pytest

import flexbase as fb
from flexbase.model.sensing import Sensing
from flexbase.sampled.judged import Judged, robots_at
from flexbase.sampled.verdict import hardware_verdict
from flexbase.study.random_poses import random_poses
from flexbase.synthesis import controller_for
from flexbase.synthesis.methods.robust import STAGES
from flexbase.synthesis.search.shaping import slow_gain
from flexbase.synthesis.search.stiffest import stiffest


@pytest.mark.parametrize("seed", [3, pytest.param(4, marks=pytest.mark.slow)])
def test_beats_the_table(paper: fb.Plant, seed: int) -> None:
    """1 kHz x1: every one of ten random poses stable, with both margins, all eight changes, at 2.8e4 N/m and more."""
    for pose in random_poses(paper, 10, seed):
        verdict = hardware_verdict(controller_for(pose, "robust"))
        assert verdict.stable
        assert verdict.has_margin
        assert verdict.survives
        assert (verdict.tip_stiffness or 0.0) >= 2.8e4


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "index"), [("ur5e-pedestal", 2), ("ur5e-pedestal", 48), ("ur5e-gantry", 52)])
def test_redundant_arm_on_a_hardly_damped_base(robot: str, index: int) -> None:
    """Sixteen changed robots of a UR5e on two base joints of 1 to 3 % damping, at poses that a model of them loses."""
    pose = random_poses(fb.load(robot), 60, 0)[index]
    verdict = hardware_verdict(controller_for(pose, "robust"))
    assert verdict.survives
    assert verdict.has_margin
    assert (verdict.tip_stiffness or 0.0) > 0.5 * 2e4
    assert (verdict.tip_correction or 0.0) > 0.9


@pytest.mark.slow
def test_singular_direction_is_left_to_the_joints() -> None:
    """A UR5e 14 mm/rad from singular: 0.1 rad turns a direction's sign, and only joints alone survive it."""
    pose = random_poses(fb.load("ur5e-pedestal"), 60, 0)[34]
    assert np.linalg.svd(pose.J[:, pose.arm.m :], compute_uv=False)[-1] < 0.02
    verdict = hardware_verdict(controller_for(pose, "robust"))
    assert verdict.survives
    assert verdict.has_margin
    assert verdict.tip_correction == pytest.approx(0.0, abs=1e-9)
    tip = controller_for(pose, "robust", stages=STAGES[:-1])
    assert not tip.notes["accepted"]


@pytest.mark.parametrize("margin", [0.3, 0.4, 0.5])
def test_asked_margin_is_kept(paper_pose: fb.Pose, margin: float) -> None:
    """At torques and sensors, with all changes, and not by a soft loop: 0.3 Kp at the tip."""
    verdict = hardware_verdict(controller_for(paper_pose, "robust", margin=margin))
    assert min(verdict.disk_margin_torque, verdict.disk_margin_sensor) >= margin
    assert verdict.survives
    assert (verdict.tip_stiffness or 0.0) >= 3e4


def test_slow_gain_is_its_ratio_at_rest() -> None:
    """Exactly the ratio at rest, within 5 % of 1 a decade above the turn, half-way near the corner."""
    one = slow_gain(3.0, 20.0, 1e-3)
    gain = np.abs(one.transfer_function(np.array([1e-6, 600.0]))[:, 0, 0])
    assert gain[0] == pytest.approx(3.0, rel=1e-9)
    assert gain[1] == pytest.approx(1.0, abs=0.05)
    continuous = abs((20j + 60.0) / (20j + 20.0))
    assert np.abs(one.transfer_function(np.array([20.0]))[0, 0, 0]) == pytest.approx(continuous, rel=1e-3)


def test_quick_acceptance_is_the_verdicts(paper: fb.Plant) -> None:
    """What a trial says in passing agrees with the verdict, which shares only the sampled plant with it."""
    agreed = {True: 0, False: 0}
    for pose in random_poses(paper, 4, 9):
        robots = robots_at(pose, Sensing())
        for scale in (0.03, 0.3, 1.0):
            trial = Judged(controller_for(pose, "coprime", scale=scale), robots)
            verdict = hardware_verdict(trial.controller)
            assert trial.survives == verdict.survives
            assert trial.accepted() == (verdict.survives and verdict.has_margin)
            if abs(min(trial.margins) - 0.3) > 0.01:
                assert trial.seems_accepted() == trial.accepted()
            assert trial.worst_radius == pytest.approx(verdict.worst_radius, rel=1e-9)
            agreed[trial.accepted()] += 1
    assert min(agreed.values()) > 0


def test_bisection_ends_beside_a_refusal() -> None:
    """On a made-up acceptance, scale <= 0.37: the largest accepted scale is within 2 % of it."""

    class Made:
        def __init__(self, scale: float) -> None:
            self.scale = self.stiffness = scale

        def seems_accepted(self, _margin: float) -> bool:
            return self.scale <= 0.37

    tried = stiffest(lambda scale: Made(scale), 0.3, halvings=7)  # type: ignore[arg-type, return-value]
    best = max(one.scale for one in tried if one.seems_accepted(0.3))  # type: ignore[attr-defined]
    assert 0.98 * 0.37 <= best <= 0.37
    softer = stiffest(lambda scale: Made(scale), 0.3, softest=0.6)  # type: ignore[arg-type, return-value]
    assert [one.scale for one in softer] == [1.0, 0.5]  # type: ignore[attr-defined]
