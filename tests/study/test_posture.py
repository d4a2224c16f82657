"""The best posture for a target: against brute force, and its derivatives against differences and complex steps."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import flexbase as fb
from flexbase.dynamics.inverse.newton import TOLERANCE, TipProblem, solve_rows
from flexbase.errors import InputError, Unreachable
from flexbase.linear.reduced import robustness
from flexbase.measures import MEASURES
from flexbase.model.task import ROWS, Task
from flexbase.plant import Plant
from flexbase.study.postures.best_postures import postures
from flexbase.study.postures.objective import make_objective
from flexbase.sweeps.cells.parameters import configuration_of
from flexbase.sweeps.engine.evaluate import Engine
from flexbase.sweeps.engine.formula import Formula
from systems.planar import planar

THREE = {1: [0.1, 0.3, 0.25, 0.2], 2: [0.1, 0.15, 0.3, 0.25, 0.2]}  # three arm joints on one or two base joints


def worst_of(plant: Plant, joints: np.ndarray, measure: str) -> np.ndarray:
    """The worst mode's value of rows of joints, by NumPy rows: no kernel, no derivative."""
    n = plant.arm.n
    question = Formula(plant.arm, (MEASURES[measure],), tuple(range(n)), (0.0,) * n)
    return Engine(question).run(np.ascontiguousarray(joints.T)).values[measure].min(axis=1)


def by_modes(pose: fb.Pose, measure: str) -> float:
    """The same of one pose, by its modal analysis."""
    return min(getattr(mode, measure) for mode in fb.modes(pose).modes)


def self_motion(plant: Plant, target: np.ndarray, count: int = 20001) -> np.ndarray:
    """Every posture of three planar links on a target, by the angle of the first and the side of the other two."""
    *base, a, b, c = [float(x) for x in THREE[plant.arm.m]]
    first = np.linspace(-np.pi, np.pi, count)
    x, y = target[0] - sum(base) - a * np.cos(first), target[1] - a * np.sin(first)
    cosine = (x * x + y * y - b * b - c * c) / (2.0 * b * c)
    first, x, y, cosine = (part[np.abs(cosine) < 1.0] for part in (first, x, y, cosine))
    rows = []
    for side in (1.0, -1.0):
        bend = side * np.arccos(cosine)
        second = np.arctan2(y, x) - np.arctan2(c * np.sin(bend), b + c * np.cos(bend))
        rows.append(np.column_stack([first, second - first, bend]))
    return np.concatenate(rows)


@pytest.mark.parametrize("measure", ["robustness", "alignment", "manipulability"])
@pytest.mark.parametrize("m", [1, 2])
@pytest.mark.parametrize("target", [[0.55, 0.2], [0.3, -0.4], [-0.2, 0.15]])
def test_no_sampled_posture_is_better(m: int, measure: str, target: list[float]) -> None:
    """The self-motion in steps of 3e-4 rad: misses a smooth optimum by 1e-6 of the spread, one at a kink by 1e-3."""
    plant = planar(THREE[m], m=m, damping=0.0)
    found = postures(plant, target, measure)
    rows = self_motion(plant, np.array(target))
    assert plant.at(rows[7]).tip == pytest.approx(target, abs=1e-12)
    values = (
        worst_of(plant, rows, measure)
        if MEASURES[measure].per_mode
        else Engine(Formula(plant.arm, (MEASURES[measure],), (0, 1, 2), (0.0,) * 3)).run(rows.T.copy()).values[measure]
    )
    spread = float(np.nanmax(values) - np.nanmin(values))
    assert found.best.value >= np.nanmax(values) - 1e-10 * spread
    assert found.best.value == pytest.approx(np.nanmax(values), abs=1e-3 * spread)
    assert found.best.pose.tip == pytest.approx(target, abs=1e-10)


@pytest.mark.parametrize(
    ("robot", "tip"),
    [("ur5e-pedestal", [0.4, 0.2, 1.0]), pytest.param("iiwa-platform", [0.5, 0.2, 1.0], marks=pytest.mark.slow)],
)
@pytest.mark.filterwarnings("ignore:posture")
def test_no_random_posture_is_better(robot: str, tip: list[float]) -> None:
    """2000 random starts brought to the target; the value is that of the modal analysis, to 1e-9 of it."""
    plant = fb.load(robot)
    found = postures(plant, tip)
    problem = TipProblem(plant.arm.mechanism, plant.arm.task, plant.arm.base.equilibrium)
    starts = np.random.default_rng(3).uniform(-np.pi, np.pi, (2000, plant.arm.n))
    rows, errors = solve_rows(problem, starts, np.array(tip))
    rows = rows[errors <= TOLERANCE * problem.scale]
    assert len(rows) > 1500
    values = worst_of(plant, rows, "robustness")
    assert found.best.value > np.nanmax(values)
    assert found.best.value == pytest.approx(worst_of(plant, found.best.joints[None], "robustness")[0], rel=1e-6)
    assert found.usual is not None
    assert found.best.value > 0.2 * found.usual.value
    assert found.best.pose.tip == pytest.approx(tip, abs=1e-10)


def test_optimum_at_a_kink_is_exact() -> None:
    """UR5e: at the best posture both modes are worth the same, to 1e-9, and no direction of the self-motion improves
    both: the gradients along it point against each other, with a resultant below 1e-6 for some convex combination."""
    plant = fb.load("ur5e-pedestal")
    found = postures(plant, [0.4, 0.2, 1.0])
    one, other = found.best.modes
    assert one == pytest.approx(other, rel=1e-9)
    _, slopes = make_objective(plant, "robustness", None)(found.best.joints[None])
    null = np.linalg.svd(found.best.pose.J[:, plant.arm.m :])[2][plant.arm.k :]
    a, b = slopes[0] @ null.T
    share = float(np.clip(b @ (b - a) / ((a - b) @ (a - b)), 0.0, 1.0))
    assert np.linalg.norm(share * a + (1.0 - share) * b) < 1e-6 * max(np.linalg.norm(a), np.linalg.norm(b))


@pytest.mark.parametrize("measure", ["robustness", "alignment"])
@pytest.mark.parametrize("robot", ["ur5e-pedestal", "iiwa-gantry"])
def test_gradient_against_differences_of_the_modal_analysis(robot: str, measure: str) -> None:
    """Central differences in steps of 1e-5 of what `modes` gives: 1e-7 of the largest slope. Undamped, so that shapes
    are real."""
    plant = fb.load(robot)
    base = dataclasses.replace(plant.arm.base, damping=0.0 * plant.arm.base.damping)
    plant = Plant(dataclasses.replace(plant.arm, base=base))
    joints = np.random.default_rng(5).uniform(-2.0, 2.0, (3, plant.arm.n))
    values, slopes = make_objective(plant, measure, None)(joints)

    def witness(row: np.ndarray) -> np.ndarray:
        return np.array([getattr(mode, measure) for mode in fb.modes(plant.at(row)).modes])

    h = 1e-5
    for row, value, slope in zip(joints, values, slopes, strict=True):
        assert witness(row) == pytest.approx(value, abs=1e-9 * np.abs(values).max())
        for i, step in enumerate(h * np.eye(plant.arm.n)):
            rate = (witness(row + step) - witness(row - step)) / (2.0 * h)
            assert slope[:, i] == pytest.approx(rate, abs=1e-7 * np.abs(slopes).max())


def test_gradient_against_complex_steps() -> None:
    """One base joint: the formulas themselves, with an imaginary step of 1e-30, give the slopes to rounding: 1e-12."""
    plant = planar(THREE[1])
    joints = np.random.default_rng(6).uniform(-2.0, 2.0, (5, 3))
    _, slopes = make_objective(plant, "robustness", None)(joints)
    for row, slope in zip(joints, slopes, strict=True):
        for i in range(3):
            bent = tuple(complex(x, 1e-30 if j == i else 0.0) for j, x in enumerate(row))
            mode = configuration_of(plant.arm, bent, {}, None).modes[0]
            assert slope[0, i] == pytest.approx(robustness(mode.a, mode.b).imag / 1e-30, abs=1e-12)


def test_all_branches_of_two_links_are_compared() -> None:
    """The paper's pose and its mirror: values of the modal analysis, and of `at_tip` on each branch."""
    plant = fb.load("ueda2003")
    found = postures(plant, [0.33, -0.25])
    assert [one.branch for one in found.found] == ["-", "+"]
    for one in found.found:
        pose = plant.at_tip([0.33, -0.25], one.branch)
        assert one.joints == pytest.approx(pose.q[1:], abs=1e-12)
        assert one.value == pytest.approx(by_modes(pose, "robustness"), rel=1e-9)
    assert found.usual is not None
    assert found.usual.value == found.found[1].value
    assert postures(plant, [0.33, -0.25], branch="+").best.branch == "+"
    costs = [one.value for one in postures(plant, [0.33, -0.25], "exact_gain").found]
    assert costs == sorted(costs)
    assert "0.0019" in found.summary()


def test_all_eight_branches_of_a_full_pose_are_compared() -> None:
    """UR5e with six task rows: each solution of `plant.solutions` once, the best of them first."""
    arm = fb.load("ur5e-pedestal").arm
    plant = Plant(dataclasses.replace(arm, task=Task(ROWS), gains=None))
    tip = plant.at([0.3, -1.2, 1.4, -1.5, -1.4, 0.2]).tip
    found = postures(plant, tip, "alignment")
    assert sorted(one.branch for one in found.found) == sorted(one.branch for one in plant.solutions(tip))
    values = [by_modes(plant.at_tip(tip, one.branch), "alignment") for one in found.found]
    assert [one.value for one in found.found] == pytest.approx(values, abs=1e-6)  # damping of 1 % bends the shapes
    assert values == sorted(values, reverse=True)
    assert len(values) == 8
    assert [one.branch[1] for one in postures(plant, tip, "alignment", branch="-").found] == ["-"] * 4


def test_a_compensator_is_used() -> None:
    """On the exact design's own branch the worst mode is at zero; on the other it is not."""
    plant = fb.load("ueda2003")
    E = fb.design(plant.at_tip([0.33, -0.25]), method="exact", natural_frequency=346.8)
    found = postures(plant, [0.33, -0.25], loop=E)
    assert (found.best.branch, found.compensated) == ("+", True)
    assert found.best.value == pytest.approx(0.0, abs=1e-12)


def test_gravity_sags_the_base_and_the_tip_stays() -> None:
    """With gravity the tip of the pose is on the target, to 1e-9, and the warning says what values leave out."""
    plant = planar(THREE[1], gravity=(0.0, -9.81, 0.0))
    with pytest.warns(fb.FlexbaseWarning, match="gravity"):
        found = postures(plant, [0.55, 0.2])
    assert found.best.pose.tip == pytest.approx([0.55, 0.2], abs=1e-9)
    assert abs(found.best.pose.q[0]) > 1e-5


@pytest.mark.parametrize("branch", [None, "+"])
def test_out_of_reach(branch: str | None) -> None:
    with pytest.raises(Unreachable, match=r"tip: \[2\.0, 0\.0\] is reached by .* in no posture"):
        postures(fb.load("ueda2003"), [2.0, 0.0], branch=branch)
    with pytest.raises(Unreachable):
        postures(planar(THREE[1]), [2.0, 0.0], branch=branch)


@pytest.mark.parametrize(
    ("measure", "words"),
    [
        ("turn", "alignment is its cosine"),
        ("worst_robustness", "robustness takes"),
        ("highest_gain", "slow"),
        ("x", "unknown"),
    ],
)
def test_measures_that_cannot_be_climbed_are_named(measure: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        postures(fb.load("ueda2003"), [0.33, -0.25], measure)
