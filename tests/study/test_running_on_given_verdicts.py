"""What studies, maps and comparisons of verdicts count, on verdicts that are given."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import flexbase as fb
from flexbase.cautions import caution
from flexbase.errors import Infeasible
from flexbase.model.loop import loop_on
from flexbase.study.running import comparison, hardware_map, hardware_study
from flexbase.study.running import region as regions
from flexbase.study.running.hardware_study import NO_DESIGN, SETTINGS, TOLD, Outcome, Setting
from flexbase.synthesis import HARDWARE_METHODS

NONE = dict.fromkeys(TOLD)
OUTCOMES = [
    NO_DESIGN,
    Outcome(True, False, False, False, {}),
    Outcome(True, True, True, False, {**NONE, "tip_stiffness": 1.0}),
    Outcome(True, True, False, True, {**NONE, "tip_stiffness": 5.0}),
    Outcome(True, True, True, True, {**NONE, "tip_stiffness": 2.0, "tip_correction": 0.5}),
]


def test_shares_are_counted_apart() -> None:
    """Of five: one without a design, three stable, two with margins, two when changed, one complete."""
    row = hardware_study._row("lqg", Setting(4000.0, 0.25), OUTCOMES)
    assert (row.method, row.rate_hz, row.gain_scale, row.poses) == ("lqg", 4000.0, 0.25, 5)
    assert (row.no_design_share, row.stable_share) == (0.2, 0.6)
    assert (row.margin_share, row.perturbed_share, row.complete_share) == (0.4, 0.4, 0.2)
    assert row.stable_interval == hardware_study.share_interval(3, 5)
    assert row.margin_interval == row.perturbed_interval == hardware_study.share_interval(2, 5)
    assert row.complete_interval == hardware_study.share_interval(1, 5)
    assert row.medians == {**NONE, "tip_stiffness": 2.0, "tip_correction": 0.5}


def refuse(*_: object) -> None:
    raise Infeasible("none there")


def test_a_method_without_a_design_is_nothing(paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch) -> None:
    loop = loop_on(paper_pose.arm)
    monkeypatch.setitem(HARDWARE_METHODS, "lqg", HARDWARE_METHODS["lqg"]._replace(make=refuse))
    assert hardware_study._outcome(paper_pose, "lqg", Setting(4000.0, 1.0), loop) == (False, False, False, False, {})


@pytest.mark.parametrize(("rate", "stable"), [(1000.0, False), (4000.0, True)])
def test_a_design_is_judged_without_its_cautions(
    paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch, rate: float, stable: bool
) -> None:
    """A caution of the ideal design would be an error here; its verdict says it better."""
    real = HARDWARE_METHODS["exact"]

    def cautious(*asked: object, **options: object) -> object:
        caution("said of the ideal design")
        return real.make(*asked, **options)

    monkeypatch.setitem(HARDWARE_METHODS, "exact", real._replace(make=cautious))
    sensing = fb.Sensing(rate=rate)
    found = hardware_study._outcome(paper_pose, "exact", Setting(rate, 1.0), loop_on(paper_pose.arm))
    assert (found.designed, found.stable, found.margin) == (True, stable, False)
    assert set(found.tip) == (set(TOLD) if stable else set())
    (one,) = fb.compare(paper_pose, ["exact"], fb.Loop(sensing=sensing)).contenders
    assert one.verdict is not None
    assert one.verdict.stable == stable


def test_what_is_studied_unless_said_otherwise() -> None:
    assert SETTINGS == ((1000.0, 0.25), (1000.0, 1.0), (1000.0, 4.0), (4000.0, 1.0), (4000.0, 4.0))
    usual = inspect.signature(fb.hardware_study).parameters
    assert (usual["poses"].default, usual["seed"].default, usual["settings"].default) == (400, 0, SETTINGS)
    assert hardware_map.USUAL_SHAPE == (50, 50)


def test_progress_counts_poses_times_methods(paper: fb.Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hardware_study, "_outcome", lambda *_: NO_DESIGN)
    steps: list[tuple[str, int, int]] = []
    fb.hardware_study(paper, poses=2, methods=["none", "lqg"], workers=1, progress=lambda *step: steps.append(step))
    assert steps == [("poses times methods", done, 4) for done in (1, 2, 3, 4)]


def test_progress_of_a_comparison_begins_with_nothing_done(
    paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(comparison, "_contender", lambda *_: None)
    steps: list[tuple[str, int, int]] = []
    fb.compare(paper_pose, ["none", "lqg"], progress=lambda *step: steps.append(step))
    assert steps == [("none", 0, 2), ("lqg", 1, 2)]


UPRIGHT = fb.Cells(shape=(2, 3), bounds=(0.4, 0.5, -0.1, 0.1), hold=(0.9,))


def test_a_map_of_an_arm_in_space_is_over_its_tip(monkeypatch: pytest.MonkeyPatch) -> None:
    """A UR5e, three rows: the cell's own pose is asked, on the branch that is named, and the figures are its own."""
    asked: list[fb.Pose] = []

    def judge(_: object, pose: fb.Pose) -> tuple[int, list[float]]:
        asked.append(pose)
        return 0, [float(pose.tip[0]), *([0.0] * (len(hardware_map.MEASURES) - 1))]

    monkeypatch.setattr(hardware_map.Judge, "__call__", judge)
    plant = fb.load("ur5e-pedestal")
    serial = fb.Execution(workers=1)
    found = fb.hardware_map(plant, "none", UPRIGHT, execution=serial)
    tips = np.array([pose.tip for pose in asked])
    assert sorted({*tips[:, 0].round(9)}) == [0.4, 0.5]
    assert tips[:, 2] == pytest.approx(np.full(6, 0.9))
    assert found["spectral_radius"].values == pytest.approx(np.tile([0.4, 0.5], (3, 1)))
    assert (found.attrs["compensated"], found.attrs["judged"]) == (0, "method none at 1000 Hz")
    assert '"branch": "-++"' in fb.hardware_map(
        plant, "none", fb.Cells(shape=(2, 2), bounds=(0.4, 0.5, -0.1, 0.1), hold=(0.9,), branch="-++"), execution=serial
    ).attrs["flexbase_recipe"].replace("'", '"')
    given = fb.hardware_map(plant, "none", UPRIGHT, loop=fb.Loop(fb.Gain(0.1 * np.eye(6))), execution=serial)
    assert (given.attrs["compensated"], given.attrs["judged"]) == (1, "given E at 1000 Hz")


def test_a_region_of_an_arm_in_space_is_around_its_tip(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(regions.Grade, "__call__", lambda _, pose: (0, (regions.SAFE if pose.tip[0] > 0.5 else 1,)))
    pose = fb.load("ur5e-pedestal").at_tip([0.5, 0.2, 0.9])
    found = fb.region(pose, "none", half_width=0.02, shape=(2, 2), execution=fb.Execution(workers=1))
    assert found.grade.tolist() == [[1, regions.SAFE]] * 2


def test_a_given_gain_is_part_of_what_a_map_depends_on(paper: fb.Plant) -> None:
    arm = loop_on(paper.arm)
    judge = hardware_map.Judge("lqg", arm.sensing, arm.gains, None)
    assert (judge.recipe["hardware"], judge.recipe["compensator"]) == ("lqg", None)
    judge = hardware_map.Judge("none", arm.sensing, arm.gains, np.eye(2))
    assert (judge.recipe["hardware"], judge.recipe["compensator"]) == ("given E", [[1.0, 0.0], [0.0, 1.0]])
