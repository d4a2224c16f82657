"""The agreement study: it is blind to the verdict, counts right, does not depend on timing, and shows what is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

import flexbase as fb
from flexbase import InputError
from flexbase.sampled.closed import close_loop
from flexbase.study.agreement import move as agreement_move
from flexbase.study.agreement import study
from flexbase.study.agreement.case import Outcome, _driven, draw_case
from flexbase.study.agreement.nudge import explain, growth_of, watch
from flexbase.study.agreement.study import Agreement, agreement

pytest.importorskip("mujoco")

QUICK = ("none", "coprime", "exact")
POSES = 16


@pytest.fixture(scope="module")
def small(paper):
    return agreement(paper, poses=POSES, methods=QUICK, workers=1)


def test_verdicts_come_true(small):
    """Sixteen poses; the whole study has 500 and 2 %, which none of sixteen may break."""
    found = small.to_dict()
    assert found["agreement"] == 1.0
    assert found["disagreements"] == []
    assert 0.3 <= found["share_stable"] <= 0.7
    assert found["constant_predictor"]["agreement"] <= 0.7
    assert len({case["method"] for case in found["cases"]}) == len(QUICK)
    assert sum(found["confusion"].values()) == found["poses"] == POSES


def test_growth_is_what_the_linear_loop_promises(small):
    """Not only the sign: over half of the cases within 10 %; beating between modes blurs some slopes."""
    assert small.growth_error < 0.1


def test_wrong_verdicts_are_found_and_not_explained_away(small):
    """Radii mirrored at 1: the outcomes, which the verdict does not touch, contradict every one of them."""
    mirrored = tuple(replace(case, radius=2.0 - case.radius) for case in small.cases)
    assert [watch(case) for case in mirrored[:2]] == list(small.outcomes[:2])
    wrong = replace(small, cases=mirrored)
    assert wrong.agreement == 0.0
    assert wrong.false_stable_rate == wrong.false_unstable_rate == 1.0
    assert len(wrong.disagreements()) == POSES
    far = max(mirrored, key=lambda case: abs(case.radius - 1.0))
    assert explain(far)["why"].startswith("unexplained")


@pytest.mark.slow
def test_a_loop_at_the_border_is_explained_by_its_radius(paper_pose):
    """Drives so strong that the radius is 1 + 1e-5; called stable, it is the border's fault, with the figures."""
    soft = draw_case(paper_pose, 0, 0, 0, ("none",))

    def driven(log_drive):
        controller = _driven(soft.controller, float(np.exp(log_drive)))
        return replace(soft, controller=controller, pose=paper_pose, radius=close_loop(paper_pose, controller).radius)

    border = driven(brentq(lambda x: driven(x).radius - 1.0 - 1e-5, -4.0, 4.0))
    assert not watch(border).settled
    why = explain(replace(border, radius=1.0 - 1e-5))["why"]
    assert why.startswith("the border itself")
    assert f"measured {border.radius:.6f}"[:-1] in why


def test_the_answer_does_not_depend_on_the_workers(small, paper):
    """Verdicts and outcomes are equal; radii to 1e-6, since LAPACK rounds with where in memory a matrix lies."""
    again = agreement(paper, poses=POSES, methods=QUICK, workers=2)
    for one, other in zip(small.to_dict()["cases"], again.to_dict()["cases"], strict=True):
        assert one["spectral_radius"] == pytest.approx(other["spectral_radius"], rel=1e-6)
        same = ("number", "method", "rate_hz", "gain_scale", "change", "drive", "settled", "predicted_stable")
        assert [one[name] for name in same] == [other[name] for name in same]


def test_rates_are_counted_by_outcome(small):
    """Two of three that settle called unstable; one of one that does not called stable."""
    cases = [replace(small.cases[0], number=i, radius=radius) for i, radius in enumerate((1.1, 1.2, 0.9, 0.8))]
    outcomes = [Outcome(settled, "slope", 1.0, -1.0) for settled in (True, True, True, False)]
    found = Agreement("x", "nudge", 0, tuple(cases), tuple(outcomes), 0, 0)
    assert found.agreement == 0.25
    assert found.false_unstable_rate == pytest.approx(2 / 3)
    assert found.false_stable_rate == 1.0
    assert found.constant_predictor() == {
        "says": "stable",
        "agreement": 0.75,
        "false_stable_rate": 1.0,
        "false_unstable_rate": 0.0,
    }


def test_growth_of_a_pure_exponential():
    sizes = 3.0 * np.exp(-7.0 * 0.05 * np.arange(12))
    assert growth_of(sizes, 0.05) == pytest.approx(-7.0)
    assert np.isnan(growth_of(sizes[:1], 0.05))


def test_classes_are_balanced_by_drawing_again(paper, monkeypatch):
    """The commoner class stops at its share; a mix of one class alone is refused and says so."""
    monkeypatch.setattr(study, "ATTEMPTS", 2)
    with pytest.raises(InputError, match="do not balance"):
        agreement(paper, poses=12, methods=["exact"], workers=1)


def test_draws_are_by_number_alone(paper_pose):
    one, two = (draw_case(paper_pose, 3, 1, 0, QUICK) for _ in range(2))
    assert one.to_dict() == two.to_dict()
    assert draw_case(paper_pose, 4, 1, 0, QUICK).to_dict() != one.to_dict()


def test_wrong_words_are_named(paper):
    with pytest.raises(InputError, match="method"):
        agreement(paper, poses=4, methods=["magic"])
    with pytest.raises(InputError, match="workers"):
        agreement(paper, poses=4, workers=-1)
    with pytest.raises(InputError, match="poses"):
        agreement(paper, poses=0)
    assert fb.agreement is agreement


@pytest.fixture(scope="module")
def moved(paper):
    return agreement(paper, poses=10, trial="move", methods=QUICK, workers=1)


@pytest.mark.slow
def test_moves_are_the_same_controllers_with_noise_and_limits(moved, paper):
    """Counts and limits are drawn, all else is the nudge's. Nine of ten verdicts come true, the rest is explained.

    The limits are so tight that a few stable loops do not come to rest.
    """
    nudged = agreement(paper, poses=10, methods=QUICK, workers=1)
    for one, other in zip(moved.cases, nudged.cases, strict=True):
        assert one.radius == pytest.approx(other.radius, rel=1e-6)
        assert one.controller.sensing.encoder_counts is not None
        assert other.controller.sensing.encoder_counts is None
        assert min(one.controller.sensing.torque_limit) > 0.0
    found = moved.to_dict()
    assert found["trial"] == "move"
    assert found["agreement"] >= 0.9
    assert all("true of a nudge" in one["explanation"]["why"] for one in found["disagreements"])
    assert {case["seen"] for case in found["cases"]} <= {"at rest", "away", "diverged"}
    assert 0 < found["complete"]["cases"] < sum(case.stable for case in moved.cases)
    assert found["complete"]["settled"] == found["complete"]["cases"]


@pytest.mark.slow
def test_what_takes_a_verdict_away_is_named(moved):
    """Drives that can hardly move the arm: a stable loop stays away, and it is the limits that explain it."""
    case = next(one for one in moved.cases if one.stable)
    weak = replace(case.controller.sensing, torque_limit=(1e-3, 1e-3), torque_slew=(1.0, 1.0))
    feeble = replace(case, controller=replace(case.controller, sensing=weak))
    assert not agreement_move.watch(feeble).settled
    assert "limits" in agreement_move.explain(feeble)["why"]


def test_drives_that_do_not_move_the_tip_have_torque_too():
    """A UR5e's last joint turns the tool in place: its drive is not dead."""
    plant = fb.load("ur5e-pedestal")
    case = draw_case(plant.at((0.0, -1.2, 1.6, -0.4, 1.5, 0.0)), 0, 0, 0, ("none",))
    limits = agreement_move.prepared(case, 0).controller.sensing.torque_limit
    assert min(limits) >= agreement_move.LEAST * case.controller.pose.M[-1, -1] > 0.0
