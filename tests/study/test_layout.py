"""Layouts: against brute force over the shifts, by modal analysis, and what they say of targets out of reach."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import flexbase as fb
from flexbase.dynamics.inverse.two_joint_arm import two_joint_angles, two_joint_arm
from flexbase.errors import InputError, Unreachable
from flexbase.measures import MEASURES
from flexbase.model.task import ROWS, Task
from flexbase.plant import Plant
from flexbase.study.layout.best_layout import layout
from flexbase.study.layout.placement import Placement
from flexbase.study.layout.targets import read_targets
from flexbase.study.postures.best_postures import postures
from flexbase.study.robust_configurations.curves import robust_curves
from flexbase.sweeps.engine.evaluate import Engine
from flexbase.sweeps.engine.formula import Formula

HOLES = np.array([[0.33, -0.25], [0.33, -0.10], [0.45, -0.10], [0.45, -0.25], [0.39, -0.17]])


def brute_force(plant: Plant, targets: np.ndarray, goal: str, shifts: np.ndarray) -> np.ndarray:
    """The goal of every shift (S, 2) by closed-form kinematics on both branches and NumPy rows."""
    arm = plant.arm
    planar = two_joint_arm(arm.mechanism, arm.task, arm.base.equilibrium)
    assert planar is not None
    question = Formula(arm, (MEASURES["alignment"],), (0, 1), (0.0, 0.0))
    everywhere = (targets[None] + shifts[:, None]).reshape(-1, 2)
    best = np.full(len(everywhere), -np.inf)
    for side in (1.0, -1.0):
        with np.errstate(invalid="ignore"):
            first, second, cosine = two_joint_angles(planar, everywhere[:, 0], everywhere[:, 1], side)
            block = Engine(question).run(np.array([first, second]))
        values = np.where((block.status == 0) & (np.abs(cosine) <= 1.0), block.values["alignment"][:, 0], -np.inf)
        best = np.fmax(best, values)
    each = best.reshape(len(shifts), len(targets))
    return each.min(axis=1) if goal == "worst" else each.mean(axis=1)


@pytest.mark.parametrize("goal", ["worst", "mean"])
@pytest.mark.parametrize("within", [0.05, 0.15, 0.6])
def test_no_shift_on_a_grid_is_better(goal: str, within: float) -> None:
    """241 x 241 shifts. The grid misses the optimum by up to a cell, times slopes of some 20/m."""
    plant = fb.load("ueda2003")
    found = layout(plant, HOLES, goal=goal, within=within)
    ticks = np.linspace(-within, within, 241)
    shifts = np.stack(np.meshgrid(ticks, ticks), axis=-1).reshape(-1, 2)
    values = brute_force(plant, HOLES, goal, shifts)
    score = found.score(found.after)
    assert score is not None
    assert score >= values.max() - 1e-9
    assert score == pytest.approx(values.max(), abs=20.0 * (ticks[1] - ticks[0]))
    assert score == pytest.approx(brute_force(plant, HOLES, goal, found.shift[None])[0], abs=1e-9)
    assert np.abs(found.shift).max() <= within


def test_before_and_after_are_what_the_modal_analysis_says() -> None:
    """Each target's joints put the tip there, to 1e-9, and have the alignment that is shown, the best there is."""
    plant = fb.load("ueda2003")
    found = layout(plant, HOLES, turn=True)
    for stations in (found.before, found.after):
        for one in stations:
            assert one.joints is not None
            pose = plant.at(one.joints)
            assert pose.tip == pytest.approx(one.tip, abs=1e-9)
            assert fb.modes(pose).modes[0].alignment == pytest.approx(one.value, abs=1e-12)
            assert one.value == pytest.approx(postures(plant, one.tip, "alignment").best.value, abs=1e-9)
    assert [one.tip.tolist() for one in found.before] == HOLES.tolist()
    moved = np.array([one.tip for one in found.after])
    turn = np.array([[np.cos(found.turn), -np.sin(found.turn)], [np.sin(found.turn), np.cos(found.turn)]])
    assert moved == pytest.approx((HOLES - found.centre) @ turn.T + found.centre + found.shift, abs=1e-12)
    straight = layout(plant, HOLES)
    assert found.score(found.after) >= straight.score(straight.after) - 1e-9


def test_a_single_target_lands_on_the_robust_curve() -> None:
    plant = fb.load("ueda2003")
    found = layout(plant, [0.33, -0.25], within=0.2)
    assert found.after[0].value == pytest.approx(1.0, abs=1e-12)
    gaps = [np.linalg.norm(one.tip - found.after[0].tip, axis=1).min() for one in robust_curves(plant).curves]
    assert min(gaps) < 0.005


@pytest.mark.slow
def test_a_redundant_arm_gains_with_every_target_on_its_best_posture() -> None:
    """UR5e, three targets, moves up to 0.1 m: the worst gains, and no posture of `postures` there is better by more
    than 1e-6."""
    plant = fb.load("ur5e-pedestal")
    targets = [[0.5, 0.2, 1.0], [0.6, 0.0, 1.0], [0.5, -0.2, 1.1]]
    found = layout(plant, targets, within=0.1)
    before, after = found.score(found.before), found.score(found.after)
    assert before is not None
    assert after is not None
    assert after > before + 0.01
    for one in found.after:
        assert one.joints is not None
        assert plant.at(one.joints).tip == pytest.approx(one.tip, abs=1e-9)
    worst = min(found.after, key=lambda one: one.value)
    assert worst.value >= postures(plant, worst.tip, "alignment").best.value - 1e-6


def test_targets_that_stay_out_of_reach_are_named() -> None:
    plant = fb.load("ueda2003")
    found = layout(plant, [[0.33, -0.25], [0.4, 0.0], [3.0, 0.0]])
    assert found.unreachable == ("3",)
    assert found.after[2].joints is None
    assert "out of reach" in found.summary()
    assert found.to_dict()["unreachable"] == ["3"]
    with pytest.raises(Unreachable, match="none is reached"):
        layout(plant, [[3.0, 0.0]], within=0.1)
    brought = layout(plant, [[1.2, 0.0], [1.3, 0.1]])
    assert brought.before[0].value is None
    assert brought.unreachable == ()


@pytest.mark.parametrize("rows", [("x", "y"), ("x", "y", "z"), ("x", "y", "z", "rz"), ROWS], ids=" ".join)
def test_slope_of_a_placement(rows: tuple[str, ...]) -> None:
    """Against central differences in steps of 1e-6, rotations as angular rates: 1e-8."""
    rng = np.random.default_rng(2)
    targets = rng.uniform(-0.8, 0.8, (4, len(rows)))
    placement = Placement(Task(rows), ("x", "y"), True, (0.1, -0.2), 1.0)
    shift, h = np.array([0.2, -0.1, 0.7]), 1e-6
    slope = placement.slope(targets, shift)
    turns = [i for i, row in enumerate(rows) if row.startswith("r")]
    for i, step in enumerate(h * np.eye(3)):
        high, low = placement.moved(targets, shift + step), placement.moved(targets, shift - step)
        rate = (high - low) / (2.0 * h)
        if len(turns) == 3:
            change = Rotation.from_rotvec(high[:, turns]) * Rotation.from_rotvec(low[:, turns]).inv()
            rate[:, turns] = change.as_rotvec() / (2.0 * h)
        assert slope[..., i] == pytest.approx(rate, abs=1e-8)


def test_full_poses_turn_with_the_work() -> None:
    """UR5e with six task rows: tool frames move as one rigid body, to 1e-9, each on the branch that is named."""
    arm = fb.load("ur5e-pedestal").arm
    plant = Plant(dataclasses.replace(arm, task=Task(ROWS), gains=None))
    joints = np.array([[0.3, -1.2, 1.4, -1.5, -1.4, 0.2], [0.6, -1.0, 1.6, -1.3, -1.1, 0.4]])
    targets = np.array([plant.at(row).tip for row in joints])
    found = layout(plant, targets, within=0.05, turn=True)
    turn = Rotation.from_rotvec([0.0, 0.0, found.turn])
    for one, target in zip(found.after, targets, strict=True):
        assert one.joints is not None
        pose = plant.at(one.joints)
        wanted = turn * Rotation.from_rotvec(target[3:])
        assert (Rotation.from_matrix(pose.target.rotation) * wanted.inv()).magnitude() < 1e-9
        assert one.branch in [each.branch for each in plant.solutions(pose.tip)]
    assert found.score(found.after) >= found.score(found.before)


def test_tables_of_targets(tmp_path: Path) -> None:
    """Columns in any order, names if given; faults name the file, the line and the column."""
    task, path = Task(("x", "y")), tmp_path / "job.csv"
    path.write_text("name, y, x\nhole, -0.25, 0.33\n,0.1,0.2\n")
    found = read_targets(task, path)
    assert (found.values.tolist(), found.names) == ([[0.33, -0.25], [0.2, 0.1]], ("hole", "2"))
    for text, words in (
        ("x\n1\n", 'no column "y"'),
        ("x,y,zz\n1,2,3\n", 'column "zz" is unknown'),
        ("x,y\n1,a\n", 'line 2: y "a" is not a number'),
        ("x,y\n1\n", 'line 2: y "" is not a number'),
        ("x,y\n", "holds no target"),
        ("x,y\n1,nan\n", "not finite"),
        ("", 'no column "x"'),
    ):
        path.write_text(text)
        with pytest.raises(InputError, match=words):
            read_targets(task, path)
    with pytest.raises(InputError, match="cannot be read"):
        read_targets(task, tmp_path / "none.csv")


def test_questions_without_meaning_are_refused() -> None:
    plant = fb.load("ueda2003")
    for options, words in (
        ({"goal": "best"}, 'goal: "best"'),
        ({"along": ["z"]}, 'no position "z"'),
        ({"within": -1.0}, "within: -1.0"),
        ({"branch": "+-+"}, "has no meaning here"),
    ):
        with pytest.raises(InputError, match=words):
            layout(plant, HOLES, **options)
    with pytest.raises(InputError, match="targets: shape"):
        layout(plant, [[1.0, 2.0, 3.0]])
    with pytest.raises(InputError, match="turn: a task of x z"):
        layout(Plant(dataclasses.replace(fb.load("ur5e-pedestal").arm, task=Task(("x", "z")))), [[0.4, 1.0]], turn=True)
