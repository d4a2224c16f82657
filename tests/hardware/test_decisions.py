"""The lines that decide whether a loop runs, pinned by numbers from outside: robots, margins, grades, choices."""

from __future__ import annotations

import copy
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import cont2discrete

import flexbase as fb
from flexbase.linear.discrete.disk_margin import grid_of
from flexbase.linear.discrete.system import Discrete, feedback
from flexbase.sampled import figures
from flexbase.sampled import judged as judging
from flexbase.sampled.judged import ALMOST, GOOD_MARGIN, SAFE, STABLE, UNSTABLE, Judged, robots_at
from flexbase.sampled.verdict import HardwareVerdict, verdict_of
from flexbase.study.running import recommend as choice
from flexbase.study.running import region as regions
from flexbase.study.running import safe_gain as gains
from flexbase.study.running.recommend import Candidate, choose_best

FAST = fb.Loop(sensing=fb.Sensing(rate=4000.0))


def bench(plant: fb.Plant, changes: dict[str, float], joints: tuple[float, ...] = (0.0, 0.0)) -> fb.Plant:
    """The paper's robot with base stiffness and last link multiplied, written out by hand."""
    arm = plant.arm
    base = replace(arm.base, stiffness=changes.get("base", 1.0) * arm.base.stiffness)
    mass, inertia = arm.mechanism.mass.copy(), arm.mechanism.inertia.copy()
    mass[-1] *= changes.get("last", 1.0)
    inertia[-1] *= changes.get("last", 1.0)
    return fb.Plant(replace(arm, base=base, mechanism=replace(arm.mechanism, mass=mass, inertia=inertia)))


def test_the_eight_robots_are_these(paper: fb.Plant, paper_pose: fb.Pose) -> None:
    """Base stiffness +-20 %, last link +-10 % in mass and inertia, each joint +-0.1 rad: no more, no less.

    M and K of each against a robot that is built by hand: the same arithmetic but for the order of products, 1e-12.
    """
    joints = paper_pose.q[1:]
    wanted = [(bench(paper, {"base": factor}), joints) for factor in (1.2, 0.8)]
    wanted += [(bench(paper, {"last": factor}), joints) for factor in (1.1, 0.9)]
    wanted += [(paper, joints + offset) for offset in ([0.1, 0.0], [-0.1, 0.0], [0.0, 0.1], [0.0, -0.1])]
    found = [fb.changed_pose(paper_pose, change) for change in fb.eight_changes(2)]
    assert len(found) == len(wanted) == 8
    for pose, (plant, at) in zip(found, wanted, strict=True):
        by_hand = plant.at(at)
        np.testing.assert_allclose(pose.M, by_hand.M, rtol=1e-12, atol=1e-12 * np.abs(by_hand.M).max())
        np.testing.assert_allclose(pose.K, by_hand.K, rtol=1e-12, atol=0.0)
        np.testing.assert_allclose(pose.tip, by_hand.tip, rtol=0.0, atol=1e-12)


def test_changes_say_what_they_are_and_act_together(paper: fb.Plant, paper_pose: fb.Pose) -> None:
    """A robot that is heavier, softer and bent at once is the one built by hand; labels name joints from 1."""
    labels = [change.label for change in fb.eight_changes(2)]
    assert labels[:4] == ["base stiffness +20 %", "base stiffness -20 %", "last link +10 %", "last link -10 %"]
    assert labels[4:] == ["joint 1 +0.1", "joint 1 -0.1", "joint 2 +0.1", "joint 2 -0.1"]
    change = fb.Changed("", base_stiffness=0.5, last_link=10.0, joints=((1, 0.3),))
    found = fb.changed_pose(paper_pose, change)
    by_hand = bench(paper, {"base": 0.5, "last": 10.0}).at(np.add(paper_pose.q[1:], [0.0, 0.3]))
    np.testing.assert_allclose(found.M, by_hand.M, rtol=1e-12, atol=1e-12 * np.abs(by_hand.M).max())
    np.testing.assert_allclose(found.K, by_hand.K, rtol=1e-12, atol=0.0)


def radius_by_scipy(pose: fb.Pose, gains: fb.Gains, sensing: fb.Sensing) -> float:
    """Spectral radius of the sampled task PD at a pose with both delays, put together from scipy's discretisation."""
    N, n, k, h = pose.arm.N, pose.arm.n, pose.arm.k, sensing.step
    inverse = np.linalg.inv(pose.M)
    A = np.block([[np.zeros((N, N)), np.eye(N)], [-inverse @ pose.K, -inverse @ pose.D]])
    B = np.vstack([np.zeros((N, n)), inverse[:, N - n :]])
    C = np.hstack([pose.J, np.zeros((k, N))])
    Ad, Bd, _, _, _ = cont2discrete((A, B, C, np.zeros((k, n))), h)
    pull, s = -pose.J[:, N - n :].T, 2 * N
    P, R = pull @ (gains.stiffness + gains.damping / h), -pull @ gains.damping / h
    # state: plant, the torque in flight, and the two last tip errors (one late, one before it)
    whole = np.zeros((s + n + 2 * k,) * 2)
    whole[:s, :s], whole[:s, s : s + n] = Ad, Bd
    whole[s : s + n, s + n : s + n + k], whole[s : s + n, s + n + k :] = P, R
    whole[s + n : s + n + k, :s] = C
    whole[s + n + k :, s + n : s + n + k] = np.eye(k)
    return float(np.abs(np.linalg.eigvals(whole)).max())


def test_the_worst_robot_by_scipy(paper: fb.Plant, paper_pose: fb.Pose) -> None:
    """Task PD at a quarter of the gains, 4 kHz: each changed robot's spectral radius by scipy, to 1e-9."""
    own = paper_pose.arm.gains
    assert own is not None
    soft = fb.Gains(0.25 * own.stiffness, 0.5 * own.damping)
    controller = fb.make_controller(paper_pose, "none", fb.Loop(gains=soft, sensing=FAST.sensing))
    here = radius_by_scipy(paper_pose, soft, controller.sensing)
    verdict = fb.hardware_verdict(controller)
    assert verdict.spectral_radius == pytest.approx(here, abs=1e-9)
    weak = radius_by_scipy(bench(paper, {"base": 0.8}).at(paper_pose.q[1:]), soft, controller.sensing)
    assert here < weak <= verdict.worst_radius + 1e-9
    assert verdict.worst_change == "joint 2 +0.1"
    # the controller keeps the Jacobian of its own pose: only robots at the same joints are so simply put together
    for label, plant in (
        ("base stiffness +20 %", bench(paper, {"base": 1.2})),
        ("last link -10 %", bench(paper, {"last": 0.9})),
    ):
        judged = Judged(controller, robots_at(paper_pose, controller.sensing))
        radius = judged.changed_radii[judged.robots.labels.index(label)]
        assert radius == pytest.approx(radius_by_scipy(plant.at(paper_pose.q[1:]), soft, controller.sensing), abs=1e-9)


@pytest.fixture(scope="module")
def verdict() -> HardwareVerdict:
    pose = fb.load("ueda2003").at_tip([0.33, -0.25])
    return fb.hardware_verdict(fb.make_controller(pose, "none", FAST), brief=True)


@pytest.mark.parametrize(
    ("stable", "torque", "sensor", "survives", "grade"),
    [
        (True, 0.3, 0.3, True, 3),
        (True, 0.2999, 5.0, True, 2),
        (True, 5.0, 0.2999, True, 2),
        (True, 0.3, 0.3, False, 2),
        (True, 0.2999, 0.3, False, 1),
        (False, 0.0, 0.0, False, 0),
    ],
)
def test_grades(
    verdict: HardwareVerdict, stable: bool, torque: float, sensor: float, survives: bool, grade: int
) -> None:
    """3 asks for both margins of 0.3 and all robots; one of the two gives 2; stability alone 1. Only 3 is safe."""
    margins = {"disk_margin_torque": torque, "disk_margin_sensor": sensor}
    told = replace(verdict, stable=stable, survives=survives, figures={**verdict.figures, **margins})
    assert (told.grade, told.safe) == (grade, grade == 3)
    assert (UNSTABLE, STABLE, ALMOST, SAFE, GOOD_MARGIN) == (0, 1, 2, 3, 0.3)


def test_a_verdict_has_its_figures_and_no_others(verdict: HardwareVerdict) -> None:
    """A margin that is not known is none; a wrong name is no attribute; copies keep what there is."""
    for name in ("disk_margin_torque", "disk_margin_sensor"):
        assert replace(verdict, figures={**FULL, name: None}).smaller_margin == 0.0
    assert replace(verdict, figures=FULL).smaller_margin == 0.5
    assert copy.copy(verdict).spectral_radius == verdict.figures["spectral_radius"]
    with pytest.raises(AttributeError, match="no figure 'nose'"):
        _ = verdict.nose


FULL = {"disk_margin_torque": 0.7, "disk_margin_sensor": 0.5}


def found_with(pose: fb.Pose, here: float, changed: list[float], margins: tuple[float, float] = (0.3, 0.3)) -> Judged:
    """A judged loop whose spectral radii and margins are given."""
    controller = fb.make_controller(pose, "none", FAST)
    kept: dict[object, object] = {("radius", i): radius for i, radius in enumerate([here, *changed])}
    judged = Judged(
        controller, robots_at(pose, controller.sensing, [fb.Changed(f"{i}") for i in range(len(changed))]), kept
    )
    vars(judged)["margins"] = margins
    return judged


def test_radii_decide(paper_pose: fb.Pose) -> None:
    """Below 1 is stable, 1 is not; what failed and what is worst are named, and one that fails fails all."""
    found = found_with(paper_pose, 0.9, [0.5, 1.2, 0.99, 1.0, float("nan")])
    assert (found.stable, found.survives, found.failed) == (True, False, ("1", "3", "4"))
    found = found_with(paper_pose, 0.9, [0.5, 1.2, 0.99, 1.0])
    assert (found.worst_radius, found.worst_change, found.grade) == (1.2, "1", ALMOST)
    assert not found.accepted()
    found = found_with(paper_pose, 0.9, [0.99, 0.5])
    assert (found.survives, found.failed, found.worst_radius, found.worst_change) == (True, (), 0.99, "0")
    assert (found.accepted(), found.accepted(0.31), found.grade) == (True, False, SAFE)
    assert not found_with(paper_pose, 0.9, [1.0]).survives
    assert not found_with(paper_pose, 0.9, [0.5, 1.0]).survives
    assert found_with(paper_pose, 1.0 - 5e-12, []).stable
    for lost in (1.0 - 5e-13, 1.0, 5.0):  # rounding decides on which side of 1 the first one lies
        found = found_with(paper_pose, lost, [0.5])
        assert (found.stable, found.survives, found.accepted(), found.grade) == (False, False, False, UNSTABLE)
    alone = found_with(paper_pose, 0.9, [])
    assert (alone.survives, alone.worst_radius, alone.worst_change) == (True, 0.9, "none")


@pytest.mark.parametrize("margins", [(0.29, 5.0), (5.0, 0.29)])
def test_both_margins_decide(paper_pose: fb.Pose, margins: tuple[float, float]) -> None:
    found = found_with(paper_pose, 0.9, [0.9], margins)
    assert (found.has_margin(), found.has_margin(0.29), found.accepted(), found.grade) == (False, True, False, ALMOST)
    assert found_with(paper_pose, 0.9, [1.1], margins).grade == STABLE


@pytest.mark.parametrize("clears", [(True, True), (True, False), (False, True)])
def test_a_quick_look_asks_for_both_margins(
    paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch, clears: tuple[bool, bool]
) -> None:
    """At torques and at sensors, against two hundredths more than the margin that is asked."""
    told: list[float] = []

    def clear(_: np.ndarray, margin: float) -> bool:
        told.append(margin)
        return clears[len(told) - 1]

    monkeypatch.setattr(judging, "_clears", clear)
    found = found_with(paper_pose, 0.9, [0.9])
    assert found.seems_accepted(0.5) == all(clears)
    assert told[0] == pytest.approx(0.51)
    assert not found_with(paper_pose, 0.9, [1.1]).seems_accepted()


def test_quick_margins_look_at_every_sensor_that_is_heard(paper_pose: fb.Pose) -> None:
    """Tip error by a state only, joints by one torque only, accelerations not at all: loop gains with all channels.

    K P by its six channels, at the same frequencies, to 1e-9; P K loses the rows of what is not heard.
    """
    made = fb.make_controller(paper_pose, "none", FAST)
    B, D = np.zeros((2, 6)), np.zeros((2, 6))
    B[0, 0], D[1, 2] = 1e-3, 0.2
    system = Discrete(0.5 * np.eye(2), B, np.ones((2, 2)), D, made.system.step)
    found = Judged(replace(made, system=system), robots_at(paper_pose, made.sensing))
    plant = found.robots.at_one_rate
    at_torques, at_sensors = found._gains_around()
    assert at_sensors.shape[1:] == (2, 2)
    used = [0, 2]
    frequencies = grid_of(feedback(plant.select(used), system.select(inputs=used)))
    wanted = system.transfer_function(frequencies) @ plant.transfer_function(frequencies)
    np.testing.assert_allclose(at_torques, wanted, rtol=1e-9, atol=1e-9 * np.abs(wanted).max())


def test_an_unstable_loop_has_no_margin_no_stiffness_and_corrects_nothing(paper_pose: fb.Pose) -> None:
    controller = fb.make_controller(paper_pose, "none", FAST)
    found = Judged(controller, robots_at(paper_pose, controller.sensing))
    assert not found.stable
    assert (found.margins, found.stiffness, found.correction) == ((0.0, 0.0), 0.0, 0.0)
    assert not found.seems_accepted()
    stable = found_with(paper_pose, 0.9, [])
    stable._kept.update(dynamic_stiffness=3e4, tip_correction=0.25)
    assert (stable.stiffness, stable.correction) == (3e4, 0.25)


class Told:
    """A judged loop whose parts are given, for the places that decide by them."""

    def __init__(self, margins: tuple[float, float], survives: bool, stable: bool = True) -> None:
        self.margins, self.survives, self.stable = margins, survives, stable

    has_margin, accepted = Judged.has_margin, Judged.accepted

    def figure(self, _: str) -> float:
        return 1.0


@pytest.mark.parametrize(
    ("told", "code"),
    [
        (Told((0.3, 0.3), True), regions.SAFE),
        (Told((0.29, 5.0), True), regions.STABLE),
        (Told((5.0, 0.29), True), regions.STABLE),
        (Told((5.0, 5.0), False), regions.STABLE),
        (Told((0.0, 0.0), False, stable=False), regions.UNSTABLE),
    ],
)
def test_a_region_asks_for_both_margins_and_all_robots(
    paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch, told: Told, code: int
) -> None:
    monkeypatch.setattr(regions, "judged", lambda *_: told)
    controller = fb.make_controller(paper_pose, "none", FAST)
    _, (found,) = regions.Grade(controller, None)(paper_pose)
    assert found == code


def test_a_safe_gain_survives_the_changed_robots(paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch) -> None:
    """Good margins up to any gain, but the changed robots hold up to twice the gains only: safe ends there."""

    def judged(robots: object, method: str, scaled: fb.Gains) -> Told:
        own = paper_pose.arm.gains
        assert own is not None
        return Told((1.0, 1.0), bool(scaled.stiffness[0, 0] <= 2.0 * own.stiffness[0, 0]))

    monkeypatch.setattr(gains, "_judged", judged)
    found = fb.safe_gain(paper_pose, "none")
    assert found.stable == pytest.approx(100.0)
    assert found.safe is not None
    assert 2.0 / 1.05 <= found.safe <= 2.0  # bisected to 4 %
    assert (gains.SMALLEST, gains.LARGEST, gains.LOOKS, gains.HALVINGS) == (1e-3, 1e2, 11, 5)


def candidate(verdict: HardwareVerdict, name: str, **changes: float) -> Candidate:
    told = {**verdict.figures, "disk_margin_torque": 0.5, "disk_margin_sensor": 0.5, **changes}
    return Candidate(name, "", replace(verdict, method=name, stable=True, survives=True, figures=told))


def test_what_counts_as_heard_and_as_close(verdict: HardwareVerdict) -> None:
    """A tenth of a tip error must be taken away, and 80 % of the best stiffness is enough for the simpler one."""
    deaf = candidate(verdict, "deaf", tip_correction=0.099, dynamic_stiffness=9e5)
    growing = candidate(verdict, "growing", tip_correction=-4.0, dynamic_stiffness=9e5)
    hears = candidate(verdict, "hears", tip_correction=0.1, dynamic_stiffness=1e4)
    assert choose_best([deaf, growing, hears]) is hears
    assert choose_best([deaf, growing]) is not None  # an answer only where no other has the grade
    near = candidate(verdict, "near", tip_correction=1.0, dynamic_stiffness=0.801e4)
    far = candidate(verdict, "far", tip_correction=1.0, dynamic_stiffness=0.799e4)
    assert choose_best([near, hears]) is near
    assert choose_best([far, hears]) is hears
    assert (choice.HEARS, choice.CLOSE) == (0.1, 0.8)


def test_a_new_figure_is_found_everywhere(paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch) -> None:
    """One registry line: verdict, document, attribute and sheets have it. Maps and studies read the same on import."""
    twice = figures.Figure("twice_radius", "1", "twice the radius", True, True, lambda one: 2.0 * one.radius)
    monkeypatch.setitem(figures.FIGURES, "twice_radius", twice)
    controller = fb.make_controller(paper_pose, "none", FAST)
    found = verdict_of(Judged(controller, robots_at(paper_pose, controller.sensing)), brief=True)
    assert found.twice_radius == 2.0 * found.to_dict()["spectral_radius"] == found.to_dict()["twice_radius"]
    assert f"twice radius        {found.twice_radius:.6g}" in found.summary()
    said = fb.compare(paper_pose, ["none"], FAST).summary()
    assert f"twice the radius  none {found.twice_radius:.4g}" in said  # without a column: below the table
    column = figures.Shown("twice", "per cent", "of itself", lambda value: f"{100.0 * value:.0f}")
    monkeypatch.setitem(figures.FIGURES, "twice_radius", twice._replace(shown=column))
    said = fb.compare(paper_pose, ["none"], FAST).summary()
    assert "[per cent]" in said
    assert "twice: of itself" in said
    assert f"{100.0 * found.twice_radius:.0f}" in said
    del figures.FIGURES["twice_radius"]
    from flexbase.study.running import hardware_map, hardware_study

    assert list(hardware_map.MEASURES) == [name for name, one in figures.FIGURES.items() if one.brief]
    assert list(hardware_study.TOLD) == [name for name, one in figures.FIGURES.items() if one.of_the_tip]


def test_makers_keep_what_they_found(paper_pose: fb.Pose) -> None:
    """A controller that was judged while it was searched for is not judged again at its pose; elsewhere it is."""
    controller = fb.make_controller(paper_pose, "viscous", FAST)
    from flexbase.sampled.judged import judged

    assert judged(controller) is controller.judged
    assert judged(controller, changes=()) is not controller.judged
    fresh = Judged(controller, robots_at(paper_pose, controller.sensing))
    assert verdict_of(judged(controller)).to_dict() == verdict_of(fresh).to_dict()
