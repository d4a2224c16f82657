"""What a recommendation says of given candidates: every sentence, and on which side of each figure it turns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.errors import Infeasible
from flexbase.linear.discrete.system import Discrete
from flexbase.sampled.judged import ALMOST, SAFE, STABLE, UNSTABLE
from flexbase.sampled.noise import torque_noise
from flexbase.sampled.verdict import HardwareVerdict
from flexbase.study.running import recommend as room
from flexbase.study.running.recommend import Candidate, Recommendation, choose_best

FIGURES = {
    "spectral_radius": 0.99,
    "disk_margin_torque": 0.5,
    "disk_margin_sensor": 0.41,
    "tip_stiffness": 98700.0,
    "dynamic_stiffness": 54000.0,
    "tip_correction": 0.956,
    "time_constant_s": 0.0123,
}


def candidate(name: str, *, survives: bool = True, stable: bool = True, **figures: float | None) -> Candidate:
    told = HardwareVerdict(name, stable, survives, (), "joint 1 +0.1", {**FIGURES, **figures})
    return Candidate(name, f"for {name}", told, None, 0.0123, 0.2, ("joint encoders", "2000 Hz"))


def recommendation(best: Candidate | None, *others: Candidate, **facts: object) -> Recommendation:
    everything = tuple(others) if best is None else (best, *others)
    sensing = fb.Sensing(rate=2000.0, compute_delay=1, task_delay=3)
    changes = {"500 Hz": "b", "8000 Hz": "a", "joint accelerometers": None}
    given = Recommendation("robot", (0.3, 0.2), sensing, True, False, best, everything, changes)
    return replace(given, **facts)  # type: ignore[arg-type]


A, B = candidate("a"), candidate("b", dynamic_stiffness=41000.0)
REFUSED = Candidate("r", "", None, refusal="two base joints")


def test_the_six_lines_of_a_safe_one() -> None:
    assert recommendation(A, B, REFUSED).lines() == [
        "Use: a, for a (2000 Hz, 1 + 3 samples late, as declared).",
        "Why: stable as it runs, survives all changed robots; disk margins 0.50 at torques, 0.41 at sensors. "
        "Next is b, at 4.1e+04 N/m.",
        "Cost: tip stiffness 9.87e+04 N/m at rest, 5.4e+04 N/m at its worst frequency; time constant 12 ms; "
        "torque noise 0.0123 N m. It corrects 96 % of what only the tip shows.",
        "Needs: joint encoders, 2000 Hz; base stiffness known to 20 %.",
        "Ideal loop: the plant is not positive real here; b: runs too, at 4.1e+04 N/m; r: no design (two base joints).",
        "Change: with 500 Hz: b; joint accelerometers: nothing stable.",
    ]


def test_where_it_is_not_safe_care_is_asked_for() -> None:
    """Weak margins or a robot that it fails with; the ideal loop, what is declared and what is needed turn too."""
    weak = replace(candidate("a", survives=False, disk_margin_sensor=0.12), stiffness_error=None)
    lost = candidate("b", stable=False)
    lines = recommendation(weak, lost, declared=False, positive_real=True, changes={"500 Hz": "a"}).lines()
    assert lines[0].startswith("Use with care: a, for a (2000 Hz, 1 + 3 samples late, assumed: the project declares no")
    assert "Why: stable as it runs, but fails with joint 1 +0.1, but below the margin of 0.3; disk" in lines[1]
    assert lines[1].endswith("No other method does as much.")
    assert lines[3].endswith("base stiffness known to better than 5 %.")
    assert lines[4] == "Ideal loop: the plant is positive real here; b: unstable."
    assert lines[5] == "Change: the same answer at every rate and sensor tried."
    rival = candidate("c", survives=False)
    assert "c: fails with joint 1 +0.1" in recommendation(A, rival).lines()[4]
    assert "c: margin 0.20" in recommendation(A, candidate("c", disk_margin_torque=0.2)).lines()[4]


def test_a_loop_at_rest_after_a_sample_takes_no_time() -> None:
    assert "time constant 0 ms" in recommendation(candidate("a", time_constant_s=None)).lines()[2]


def test_only_four_others_are_named() -> None:
    assert recommendation(A, *(candidate(name) for name in "bcdef")).lines()[4].count("runs too") == 4


def test_the_stiffest_rival_is_next() -> None:
    assert "Next is c" in recommendation(A, B, candidate("c", dynamic_stiffness=42000.0)).lines()[1]


def test_where_nothing_is_stable_the_mend_is_less_delay() -> None:
    lines = recommendation(None, candidate("b", stable=False), REFUSED).lines()
    assert lines[0] == ("Use: none of the methods is stable at this pose (2000 Hz, 1 + 3 samples late, as declared).")
    assert lines[1] == "Why: b: unstable; r: no design (two base joints)."
    assert lines[3:5] == [
        "Needs: less delay, a faster rate, or a stiffer base.",
        "Ideal loop: the plant is not positive real here.",
    ]
    assert lines[5] == "Change: with 500 Hz: b; 8000 Hz: a."


def test_grades_of_answers() -> None:
    assert (recommendation(A).grade, recommendation(None).grade, REFUSED.grade) == (SAFE, UNSTABLE, UNSTABLE)
    assert candidate("a", survives=False).grade == ALMOST
    assert candidate("a", survives=False, disk_margin_torque=0.1).grade == STABLE


def test_of_stable_ones_the_larger_margin_is_best() -> None:
    """Stiffness does not count where neither margins nor changed robots are borne; refused ones never do."""
    weak = candidate("weak", survives=False, disk_margin_torque=0.10, dynamic_stiffness=9e5)
    better = candidate("better", survives=False, disk_margin_torque=0.11)
    assert choose_best([weak, better, REFUSED]) is better
    assert choose_best([better, weak]) is better
    assert choose_best([candidate("lost", stable=False), REFUSED]) is None
    assert choose_best([]) is None


@pytest.mark.parametrize("correction", [0.0, None])
def test_what_corrects_nothing_is_no_answer_beside_what_does(correction: float | None) -> None:
    deaf = candidate("deaf", tip_correction=correction, dynamic_stiffness=9e5)
    assert choose_best([deaf, A]) is A


@pytest.mark.parametrize(("border", "told"), [(0.04, None), (0.05, 0.05), (0.29, 0.2), (0.3, 0.3), (0.9, 0.5)])
def test_how_wrong_the_base_may_be(
    paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch, border: float, told: float | None
) -> None:
    """The loop bears a softer base up to a border and any stiffer one; the error is the last tried that it survives."""

    class Found:
        def __init__(self, _: object, robots: object) -> None:
            self.changes = robots.changes  # type: ignore[attr-defined]

        @property
        def survives(self) -> bool:
            softer, stiffer = (one.base_stiffness for one in self.changes)
            assert softer < 1.0 < stiffer == pytest.approx(2.0 - softer)
            return all(one.base_stiffness >= 1.0 - border - 1e-9 for one in self.changes)

    monkeypatch.setattr(room, "Judged", Found)
    controller = fb.make_controller(paper_pose, "none")
    assert room._stiffness_error(paper_pose, controller) == told


def test_what_has_no_verdict_or_no_figure_does_nothing() -> None:
    for one in (REFUSED, candidate("a", dynamic_stiffness=None, tip_correction=None, disk_margin_torque=None)):
        assert (room._stiffness(one), room._correction(one), room._smaller_margin(one)) == (0.0, 0.0, 0.0)


def test_what_is_tried() -> None:
    assert room.RATES == (250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0)
    assert room.ERRORS == (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)


def test_sensors_are_those_that_the_law_reads(paper_pose: fb.Pose) -> None:
    """Task PD reads the tip and, with E, accelerations; lqg's observer reads encoders too."""
    loop = fb.Loop(sensing=fb.Sensing(rate=4000.0))
    plain = room._sensors(fb.make_controller(paper_pose, "none", loop))
    assert plain == ("a task sensor", "4000 Hz")
    shaped = room._sensors(fb.make_controller(paper_pose, "exact", loop))
    assert shaped == ("a task sensor", "joint accelerometers", "4000 Hz")
    assert room._sensors(fb.make_controller(paper_pose, "coprime", loop))[:2] == ("a task sensor", "joint encoders")


def test_one_channel_of_a_sensor_is_enough_to_need_it(paper_pose: fb.Pose) -> None:
    """By a state or straight through, in one of two torques: the first and the last channel of each sensor."""
    made = fb.make_controller(paper_pose, "none")
    for channel, sensor in enumerate(["a task sensor", "joint encoders", "joint accelerometers"]):
        for number in (2 * channel, 2 * channel + 1):
            for matrix in "BD":
                parts = {"B": np.zeros((2, 6)), "D": np.zeros((2, 6))}
                parts[matrix][0, number] = 1.0
                system = Discrete(np.zeros((2, 2)), parts["B"], np.eye(2), parts["D"], made.system.step)
                assert room._sensors(replace(made, system=system)) == (sensor, "1000 Hz")


def test_a_refusal_is_its_first_sentence(paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise Infeasible("exact: no such gain. Ask for another.")

    monkeypatch.setattr(room, "controller_for", refuse)
    task = (paper_pose, "exact", fb.Sensing(), paper_pose.arm.gains, False)
    found = room._candidate(task)
    assert (found.verdict, found.refusal, found.grade) == (None, "exact: no such gain", UNSTABLE)


def test_rates_and_sensors_other_than_the_own_are_tried(paper_pose: fb.Pose) -> None:
    """At 1 kHz with accelerometers the change line knows five rates and encoders; candidates here are told in full."""
    steps: list[tuple[int, int]] = []
    found = fb.recommend(
        paper_pose,
        loop=fb.Loop(sensing=fb.Sensing(rate=1000.0)),
        methods=["none", "lqg"],
        progress=lambda _, done, total: steps.append((done, total)),
    )
    assert list(found.changes) == ["250 Hz", "500 Hz", "2000 Hz", "4000 Hz", "8000 Hz", "differenced encoders"]
    assert steps == [(i + 1, 14) for i in range(14)]
    none, lqg = found.candidates
    assert (none.verdict.stable, none.torque_noise, none.stiffness_error) == (False, None, None)  # type: ignore[union-attr]
    assert lqg.torque_noise == torque_noise(paper_pose, fb.make_controller(paper_pose, "lqg")).max()
    assert lqg.verdict.delay_margin_s is not None  # type: ignore[union-attr]
    assert (found.best, found.declared) == (lqg, True)
