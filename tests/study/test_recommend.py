"""The recommendation: the best grade wins, then stiffness; every figure in it is somebody's else too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.linear.discrete.system import feedback
from flexbase.model.loop import Loop
from flexbase.model.sensing import Sensing
from flexbase.sampled.controller import SampledController, pd_with_gain
from flexbase.sampled.noise import sensor_noise, torque_noise
from flexbase.sampled.plant import sampled_plant
from flexbase.sampled.verdict import HardwareVerdict, hardware_verdict
from flexbase.study.running.recommend import Candidate, choose_best, recommend


@pytest.fixture(scope="module")
def loop(paper_pose: fb.Pose) -> SampledController:
    E = fb.design(paper_pose, method="exact", natural_frequency=346.8).E
    assert paper_pose.arm.gains is not None
    return pd_with_gain(paper_pose, Sensing(rate=4000.0, encoder_counts=1e5), paper_pose.arm.gains, E, "exact")


def test_torque_noise_is_what_a_simulation_shows(loop: SampledController) -> None:
    """200,000 samples of the loop with noisy sensors; its slowest motion takes 140 samples, so 5 % is three errors."""
    plant = sampled_plant(loop.pose, loop.sensing).select(list(range(6)), [0, 1])
    rng, sizes = np.random.default_rng(0), sensor_noise(loop)
    x, c, tau = np.zeros(plant.order), np.zeros(loop.system.order), np.zeros(2)
    total = np.zeros(2)
    noise = rng.normal(size=(200_000, 6)) * sizes
    for sample in noise:
        seen = plant.C @ x + sample  # the plant answers a torque one sample later: no direct path
        tau = loop.system.C @ c + loop.system.D @ seen
        c = loop.system.A @ c + loop.system.B @ seen
        x = plant.A @ x + plant.B @ tau
        total += tau**2
    assert torque_noise(loop.pose, loop) == pytest.approx(np.sqrt(total / len(noise)), rel=0.05)
    quiet = replace(loop, sensing=replace(loop.sensing, encoder_counts=1e12, task_noise=1e-12, acceleration_noise=1e-9))
    assert torque_noise(loop.pose, quiet).max() < 1e-4 * torque_noise(loop.pose, loop).min()


def test_torque_noise_keeps_its_digits(paper_pose: fb.Pose) -> None:
    """Base deflection by differences has entries of 1e5: a bilinear transform of its loop loses all digits but three.

    The witness lets the covariance settle sample by sample. 1e-8: far above the rounding of 4000 sums.
    """
    made = fb.make_controller(paper_pose, "deflection")
    plant = sampled_plant(paper_pose, made.sensing).select(list(range(6)), [0, 1])
    closed, spread = feedback(made.system, plant), np.diag(sensor_noise(made) ** 2)
    X = np.zeros_like(closed.A)
    for _ in range(4000):  # samples: the slowest motion, of radius 0.981, is down to 1e-33
        X = closed.A @ X @ closed.A.T + closed.B @ spread @ closed.B.T
    wanted = np.sqrt(np.diag(closed.C @ X @ closed.C.T + closed.D @ spread @ closed.D.T))
    assert torque_noise(paper_pose, made) == pytest.approx(wanted, rel=1e-8)


@pytest.fixture(scope="module")
def verdict(loop: SampledController) -> HardwareVerdict:
    return hardware_verdict(loop, brief=True)


def candidate(name: str, verdict: HardwareVerdict, **changes: object) -> Candidate:
    figures = {key: value for key, value in changes.items() if key in verdict.figures}
    others = {key: value for key, value in changes.items() if key not in verdict.figures}
    told = replace(verdict, method=name, figures={**verdict.figures, **figures}, **others)  # type: ignore[arg-type]
    return Candidate(name, "", told)


def test_grade_comes_before_stiffness(verdict: HardwareVerdict) -> None:
    good = {"disk_margin_torque": 0.5, "disk_margin_sensor": 0.5, "survives": True}
    complete = candidate("soft", verdict, **good, dynamic_stiffness=1e4)
    stiff = candidate("stiff", verdict, **(good | {"survives": False}), dynamic_stiffness=1e6)
    assert choose_best([stiff, complete]) is complete
    simple = candidate("simple", verdict, **good, dynamic_stiffness=0.81e5)
    clever = candidate("clever", verdict, **good, dynamic_stiffness=1e5)
    assert choose_best([complete, simple, clever]) is simple  # earlier in the table, and 81 % as stiff
    assert choose_best([complete, clever]) is clever
    assert choose_best([candidate("none", verdict, stable=False), Candidate("no", "", None, "no gain")]) is None


def test_six_lines_at_the_papers_pose(paper_pose: fb.Pose) -> None:
    """At 1 kHz the paper's law and the exact one are unstable; at 4 kHz something runs, and the change is announced."""
    found = recommend(paper_pose, methods=["none", "exact"])
    assert found.best is None
    assert len(found.lines()) == 6
    assert not found.declared
    assert found.changes["4000 Hz"] == "exact"
    assert "4000 Hz: exact" in found.lines()[5]
    fast = recommend(paper_pose, methods=["none", "exact"], loop=Loop(sensing=Sensing(rate=4000.0)))
    assert fast.best is not None
    assert fast.best.method == "exact"
    assert fast.declared
    assert len(fast.lines()) == 6
    assert fast.to_dict()["recommended"] == "exact"
