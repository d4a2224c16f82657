"""Every registered measure: what its line in the registry says is what maps, differences and searches do with it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.measures import MEASURES
from flexbase.measures.registry import Configuration, Measure
from flexbase.study.postures.objective import Objective
from flexbase.sweeps import difference

pytestmark = pytest.mark.filterwarnings("ignore::flexbase.FlexbaseWarning")  # of coupled damping: tests of the sweeps

ROBOTS = ("ueda2003", "ur5e-gantry", "iiwa-platform")
JOINTS = np.random.default_rng(7).uniform(-2.0, 2.0, (20, 7))


def lacking(name: str, plant: fb.Plant) -> str | None:
    return MEASURES[name].needs(plant.arm.m, plant.arm.n, plant.arm.k)


FITTING = [(name, robot) for name in MEASURES for robot in ROBOTS if not lacking(name, fb.load(robot))]
LACKING = [(name, robot) for name in MEASURES for robot in ROBOTS if lacking(name, fb.load(robot))]
CLIMBED = [name for name, one in MEASURES.items() if one.no_search is None]


@pytest.mark.parametrize("name", MEASURES)
def test_the_line_is_whole(name: str) -> None:
    one = MEASURES[name]
    assert (one.name, bool(one.unit), bool(one.purpose)) == (name, True, True)
    assert one.zero_line is None or (one.zero_is and MEASURES[one.zero_line].zero_is == one.zero_is)
    assert (one.unit == "rad") == (one.period is not None)
    assert not one.slow or one.no_search
    assert not one.period or one.no_search


@pytest.mark.parametrize(("name", "robot"), FITTING)
def test_it_has_values_where_it_fits(name: str, robot: str) -> None:
    """Of 20 random postures at least one has a value; an angle stays within half a period either way."""
    plant = fb.load(robot)
    n = plant.arm.n
    found = fb.sweep(plant, [name], fb.Cells(over="samples", shape=(20,), bounds=[-2.0, 2.0] * n))[name].values
    known = found[np.isfinite(found)]
    assert known.size
    period = MEASURES[name].period
    assert period is None or np.abs(known).max() <= 0.5 * period


@pytest.mark.parametrize(("name", "robot"), LACKING)
def test_where_it_does_not_fit_it_says_what_is_missing(name: str, robot: str) -> None:
    plant = fb.load(robot)
    with pytest.raises(fb.InputError, match=str(lacking(name, plant))):
        fb.sweep(plant, [name], fb.Cells(shape=(2, 2)))


@pytest.mark.parametrize("name", [name for name, one in MEASURES.items() if one.period])
def test_an_angle_changes_by_the_shorter_way(paper: fb.Plant, name: str) -> None:
    """A map against itself, each value a hair past the jump: the change is the hair."""
    period = MEASURES[name].period
    assert period is not None
    before = fb.sweep(paper, [name], fb.Cells(shape=(9, 9)))
    after = before.copy(deep=True)
    after[name] = after[name] + period - 1e-3
    changes = difference(before, after)[name].values
    assert np.nanmax(np.abs(changes + 1e-3)) <= 1e-12


@pytest.mark.parametrize("name", CLIMBED)
def test_a_search_has_its_slopes(name: str) -> None:
    """Derivatives by every joint against central differences on three arms, to 1e-6 of the slope's size.

    Steps of 1e-5 rad: the error of the formula is some 1e-10 and that of rounding some 1e-11 of the values' curvature.
    """
    judged = 0
    for robot in (robot for one, robot in FITTING if one == name):
        arm = fb.load(robot).arm
        objective = Objective(arm, MEASURES[name], None if "radius" not in name else 0.01 * np.eye(arm.n))
        joints = JOINTS[:, : arm.n]
        slopes = objective(joints)[1]
        for i in range(arm.n):
            step = 1e-5 * np.eye(arm.n)[i]
            expected = (objective(joints + step)[0] - objective(joints - step)[0]) / 2e-5
            for row in np.flatnonzero(np.isfinite(expected).all(axis=1)):
                size = np.abs(slopes[row]).max() + np.abs(objective(joints[row : row + 1])[0]).max()
                assert np.abs(slopes[row, :, i] - expected[row]).max() <= 1e-6 * size, (robot, row, i)
                judged += 1
    assert judged


@pytest.mark.parametrize("name", CLIMBED)
def test_a_search_makes_it_best(paper: fb.Plant, name: str) -> None:
    """Of both sides of the elbow the search takes the smaller value of a cost, the larger one of all others."""
    loop = fb.Gain(0.01 * np.eye(2)) if name == "algebraic_loop_radius" else None
    found = fb.postures(paper, [0.33, -0.25], name, loop=loop)
    values = [one.value for one in found.found]
    assert len(values) == 2
    assert values == sorted(values, reverse=not MEASURES[name].small_is_good)


@pytest.mark.parametrize("name", [name for name in MEASURES if name not in CLIMBED])
def test_a_search_says_why_it_cannot_follow(paper: fb.Plant, name: str) -> None:
    for search in (
        lambda: fb.postures(paper, [0.33, -0.25], name),
        lambda: fb.layout(paper, [[0.33, -0.25]], name),
    ):
        with pytest.raises(fb.InputError) as caught:
            search()
        assert str(caught.value).startswith(f"measure {name}: {MEASURES[name].no_search}. Give one of ")


def test_a_new_measure_needs_one_line(paper: fb.Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    """A throw-away cost with a period, registered here: searches, differences and maps know it."""
    new = MEASURES["alignment"]._replace(name="new", small_is_good=True, period=4.0)
    monkeypatch.setitem(MEASURES, "new", new)
    found = fb.postures(paper, [0.33, -0.25], "new")
    assert [one.value for one in found.found] == sorted(one.value for one in found.found)
    chart = fb.sweep(paper, ["new"], fb.Cells(shape=(5, 5)))
    moved = chart.copy(deep=True)
    moved["new"] = moved["new"] + 3.9
    assert np.nanmax(np.abs(difference(chart, moved)["new"].values + 0.1)) <= 1e-12


def test_a_configuration_without_a_compensator_is_its_own_original(paper_pose: fb.Pose) -> None:
    """With E, `original` is what it was without; both read the same M."""
    arm, base = paper_pose.arm, paper_pose.arm.base
    bare = Configuration(paper_pose.M, paper_pose.J, arm.parts, base.stiffness, base.damping)
    assert bare.original is bare.reduced
    shaped = replace(bare, E=0.01 * np.eye(2))
    assert np.array_equal(shaped.original.R0, bare.reduced.R0)
    assert not np.array_equal(shaped.reduced.R0, bare.reduced.R0)


def test_a_measure_is_of_the_whole_and_good_when_large_unless_said() -> None:
    """Modes are read by those of one mode and by those of all."""
    plain = Measure("name", "1", "purpose", lambda one: 0.0)
    assert not any((plain.per_mode, plain.all_modes, plain.slow, plain.small_is_good, plain.reads_modes))
    assert plain._replace(per_mode=True).reads_modes
    assert plain._replace(all_modes=True).reads_modes
