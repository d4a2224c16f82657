"""The hardware table: shares that the verdict gives, intervals that scipy gives, the same poses for the same seed."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binomtest

import flexbase as fb
from flexbase.model.sensing import Sensing
from flexbase.sampled.verdict import hardware_verdict
from flexbase.study.random_poses import random_poses
from flexbase.study.running.hardware_study import Setting, hardware_study, share_interval
from flexbase.synthesis import controller_for

FAST, SLOW = Setting(4000.0, 1.0), Setting(1000.0, 1.0)


@pytest.mark.parametrize(("hits", "trials"), [(0, 10), (3, 10), (10, 10), (380, 400)])
def test_intervals_are_scipys(hits: int, trials: int) -> None:
    expected = binomtest(hits, trials).proportion_ci(method="exact")
    assert share_interval(hits, trials) == pytest.approx((expected.low, expected.high), abs=1e-12)


def test_rows_count_verdicts(paper: fb.Plant) -> None:
    study = hardware_study(paper, poses=8, seed=1, methods=["none", "exact"], settings=[SLOW, FAST], workers=1)
    assert [(row.method, row.rate_hz) for row in study.rows] == [
        ("none", 1000.0),
        ("none", 4000.0),
        ("exact", 1000.0),
        ("exact", 4000.0),
    ]
    verdicts = [
        hardware_verdict(controller_for(pose, "none", Sensing(rate=4000.0)), brief=True)
        for pose in random_poses(paper, 8, 1)
    ]
    row = study.rows[1]
    assert row.stable_share == np.mean([one.stable for one in verdicts])
    assert row.margin_share == np.mean([one.stable and one.has_margin for one in verdicts])
    assert row.perturbed_share == np.mean([one.survives for one in verdicts])
    assert row.medians["tip_stiffness"] == pytest.approx(1e5, rel=1e-6)
    slow = study.rows[0]  # theory §10: the paper's gains are unstable at 1 kHz even on a rigid base
    assert (slow.stable_share, slow.medians["tip_stiffness"]) == (0.0, None)
    assert {
        "method",
        "rate_hz",
        "gain_scale",
        "stable_share",
        "margin_share",
        "perturbed_share",
        "tip_stiffness",
    } <= set(study.to_dict()["rows"][0])


def test_processes_change_nothing(paper: fb.Plant) -> None:
    one, two = (
        hardware_study(paper, poses=4, methods=["none"], settings=[FAST], workers=workers).to_dict()
        for workers in (1, 2)
    )
    assert one == two


def test_poses_are_uniform_over_the_ring(paper: fb.Plant) -> None:
    """Half of the tips within the radius that halves the ring's area: within five standard errors of 300."""
    tips = np.array([pose.tip for pose in random_poses(paper, 300)])
    radii = np.linalg.norm(tips - [0.2, 0.0], axis=1)
    low, high = 0.05 + 0.02 * 0.55, 0.55 - 0.02 * 0.55
    inside = np.mean(radii < np.sqrt((low**2 + high**2) / 2.0))
    assert inside == pytest.approx(0.5, abs=5.0 * 0.5 / np.sqrt(300))
    assert np.array_equal(tips, [pose.tip for pose in random_poses(paper, 300)])


def test_wrong_questions(paper: fb.Plant) -> None:
    with pytest.raises(fb.InputError, match="at least 1"):
        random_poses(paper, 0)
    with pytest.raises(fb.InputError, match="method"):
        hardware_study(paper, poses=1, methods=["magic"])
