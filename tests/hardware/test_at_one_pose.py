"""Comparison of methods, the highest safe gain, and the region in which one controller stays valid."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.errors import InputError
from flexbase.model.loop import Gain, Loop
from flexbase.model.sensing import Sensing
from flexbase.report.figures.region import draw_validity
from flexbase.sampled.controller import pd_with_gain
from flexbase.sampled.verdict import hardware_verdict
from flexbase.study.running.comparison import compare
from flexbase.study.running.region import SAFE, STABLE, UNSTABLE, region
from flexbase.study.running.safe_gain import safe_gain
from flexbase.synthesis import controller_for

FAST = Sensing(rate=4000.0)


def verdict_at(pose: fb.Pose, scale: float) -> tuple[bool, bool]:
    gains = fb.Gains(scale * pose.arm.gains.stiffness, np.sqrt(scale) * pose.arm.gains.damping)  # type: ignore[union-attr]
    found = hardware_verdict(controller_for(pose, "none", FAST, gains), brief=True)
    return found.stable, found.stable and found.has_margin and found.survives


def test_safe_gain_is_a_border(paper_pose: fb.Pose) -> None:
    """Safe there and not 5 % above; the same for stable. [the search is to 4 %]"""
    found = safe_gain(paper_pose, "none", Loop(sensing=FAST))
    assert found.safe is not None
    assert found.stable is not None
    assert found.safe <= found.stable
    assert verdict_at(paper_pose, found.safe)[1]
    assert not verdict_at(paper_pose, 1.12 * found.safe)[1]
    assert verdict_at(paper_pose, found.stable)[0]
    assert not verdict_at(paper_pose, 1.12 * found.stable)[0]
    assert found.safe_stiffness == pytest.approx(1e5 * found.safe, rel=1e-5)
    assert "safe up to" in found.summary()
    slower = safe_gain(paper_pose, "none", Loop(sensing=Sensing()))
    assert slower.safe is None or slower.safe < found.safe


def test_comparison_holds_what_each_method_says(paper_pose: fb.Pose) -> None:
    found = compare(paper_pose, ["none", "exact"], Loop(sensing=FAST))
    for one in found.contenders:
        assert one.verdict == hardware_verdict(controller_for(paper_pose, one.method, FAST))
    assert [row["method"] for row in found.to_dict()["methods"]] == ["none", "exact"]
    assert "none" in found.summary()
    with pytest.raises(InputError, match='method: "nose" is unknown'):
        compare(paper_pose, ["nose"])


def test_a_method_without_answer_says_why() -> None:
    """exact needs one base joint: a reason, no crash."""
    pose = fb.load("ur5e-platform").at([0.3, -1.2, 1.5, -0.8, 0.4, 0.2])
    (one,) = compare(pose, ["exact"], Loop(sensing=FAST)).contenders
    assert one.verdict is None
    assert one.reason
    assert set(one.to_dict()) == {"method", "infeasible"}


def test_region_by_single_verdicts(paper_pose: fb.Pose) -> None:
    """Every cell of a small region, against a verdict of its own; radii against the distances."""
    E = fb.design(paper_pose, natural_frequency=346.8).E
    gains = fb.Gains(0.2 * paper_pose.arm.gains.stiffness, 0.45 * paper_pose.arm.gains.damping)  # type: ignore[union-attr]
    controller = pd_with_gain(paper_pose, FAST, gains, E, "exact")
    found = region(paper_pose, None, Loop(Gain(E), gains, FAST), half_width=0.12, shape=(3, 5))
    assert found.grade.shape == (5, 3)
    for (row, column), grade in np.ndenumerate(found.grade):
        if grade == 0:
            continue
        pose = paper_pose.plant.at_tip([found.x[column], found.y[row]], near=paper_pose.q[1:])
        verdict = hardware_verdict(pd_with_gain(pose, FAST, gains, E, ""), brief=True)
        safe = verdict.stable and verdict.has_margin and verdict.survives
        assert grade == (SAFE if safe else STABLE if verdict.stable else UNSTABLE)
    frozen = region(paper_pose, controller, half_width=0.12, shape=(3, 3))
    pose = paper_pose.plant.at_tip([frozen.x[0], frozen.y[0]], near=paper_pose.q[1:])
    assert (frozen.grade[0, 0] >= STABLE) == (hardware_verdict(controller, pose, changes=()).stable)
    assert frozen.what == "controller"
    assert found.to_dict()["what"] == "E"
    assert "design tip" in found.summary()
    assert draw_validity(found).axes
    with pytest.raises(InputError, match="half_width"):
        region(paper_pose, controller, half_width=-1.0)


def test_a_method_that_is_pd_with_e_keeps_e_alone(paper_pose: fb.Pose) -> None:
    small = replace(FAST, rate=2000.0)
    kept = region(paper_pose, "exact", Loop(sensing=small), half_width=0.01, shape=(2, 2))
    assert kept.what == "E"
