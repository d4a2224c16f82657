"""Kernels and NumPy rows against one pose at a time, on every bundled robot."""

from __future__ import annotations

import pickle
import warnings
from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.linear.closed_loop import abscissa, close_loop
from flexbase.measures import MEASURES
from flexbase.model.base import make_base
from flexbase.model.files.bundled import robots
from flexbase.model.mechanism import Body, with_payload
from flexbase.sweeps.engine.evaluate import Engine, compiled
from flexbase.sweeps.engine.formula import Formula
from flexbase.sweeps.engine.status import OK

POSES = 60
ROUNDING = 1e-12  # times the condition number of M: what the issue of rounding in M alone may cost


def question_of(arm: fb.Plant, parameters: tuple[str, ...] = (), E: np.ndarray | None = None) -> Formula:
    known = tuple(one for one in MEASURES.values() if not one.slow and not one.needs(arm.arm.m, arm.arm.n, arm.arm.k))
    return Formula(arm.arm, known, tuple(range(arm.arm.n)), (0.0,) * arm.arm.n, parameters, E)


def poses(plant: fb.Plant, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-2.5, 2.5, (plant.arm.n, POSES))


def condition_numbers(plant: fb.Plant, joints: np.ndarray) -> np.ndarray:
    return np.array([np.linalg.cond(plant.at(q).M) for q in joints.T])


@pytest.mark.parametrize("name", robots().descriptions)
def test_kernel_and_rows_are_the_scalar_path(name: str) -> None:
    """Every measure on floats, one configuration after the other, to 1e-12 times cond(M)."""
    plant = fb.load(name)
    question, joints = question_of(plant), poses(plant)
    kernel, rows = compiled(question).run(joints), Engine(question).run(joints)
    assert np.array_equal(kernel.status, rows.status)
    good = np.flatnonzero(kernel.status == OK)
    assert good.size > POSES // 3
    conditions = condition_numbers(plant, joints)
    for cell in good:
        values = question(tuple(joints[:, cell].tolist()))
        place = 1
        for one in question.quick:
            true = np.array(values[place : place + question.width(one)], dtype=float)
            place += question.width(one)
            for block in (kernel, rows):
                found = np.atleast_1d(block.values[one.name][cell])
                scale = np.nanmax(np.abs(block.values[one.name])) if one.unit != "rad" else 1.0
                error = np.abs(np.angle(np.exp(1j * (found - true)))) if one.unit == "rad" else np.abs(found - true)
                assert error.max() <= ROUNDING * conditions[cell] * max(scale, 1e-300), (one.name, found, true)


@pytest.mark.parametrize("name", ["ueda2003", "ur5e-pedestal", "panda-platform", "scara"])
def test_kernel_is_the_modal_analysis(name: str) -> None:
    """Frequencies and w of `fb.modes`, which solves the quadratic eigenproblem instead, where shapes are real."""
    plant = fb.load(name)
    damping = plant.arm.base.damping
    question, joints = question_of(plant), poses(plant, 1)
    found = compiled(question).run(joints)
    for cell in np.flatnonzero(found.status == OK)[:20]:
        modes = fb.modes(plant.at(joints[:, cell]))
        frequencies = [mode.frequency for mode in modes]
        light = 1e-9 if plant.arm.m == 1 else 5e-3  # real shapes: else to the damping squared
        assert found.values["frequency"][cell] == pytest.approx(frequencies, rel=light)
        if plant.arm.m == 1 or not damping.any():
            assert found.values["robustness"][cell, 0] == pytest.approx(modes[0].robustness, rel=1e-9, abs=1e-13)


def test_parameters_are_the_plants_own() -> None:
    """Stiffness, damping and payload as inputs give what projects with these numbers give, to 1e-10."""
    plant = fb.load("ur5e-pedestal")
    arm, joints = plant.arm, poses(plant, 2)
    base = make_base(1.3 * arm.base.stiffness, 0.4 * arm.base.damping, arm.base.equilibrium, arm.m)
    loaded = with_payload(arm.mechanism, Body(3.5, np.zeros(3), np.zeros((3, 3))))
    other = fb.Plant(replace(arm, base=base, mechanism=loaded))
    asked = question_of(plant, ("payload", "stiffness", "damping"))
    inputs = np.vstack([joints, np.tile([[3.5], [1.3], [0.4]], POSES)])
    found, true = compiled(asked).run(inputs), compiled(question_of(other)).run(joints)
    for one in asked.quick:
        assert found.values[one.name] == pytest.approx(
            true.values[one.name], rel=1e-10, abs=1e-10 * np.nanmax(np.abs(true.values[one.name]))
        )
    unchanged = compiled(question_of(plant)).run(joints).values["frequency"]
    assert np.abs(found.values["frequency"] / unchanged - 1.0).min() > 1e-3  # a kernel deaf to its inputs fails


def test_nominal_parameters_change_nothing() -> None:
    plant = fb.load("panda-gantry")
    joints = poses(plant)
    inputs = np.vstack([joints, np.tile([[1.0], [1.0], [0.0], [1.0]], POSES)])
    found = compiled(question_of(plant, ("stiffness", "damping", "payload", "link_mass"))).run(inputs)
    true = compiled(question_of(plant)).run(joints)
    for name, values in true.values.items():
        assert found.values[name] == pytest.approx(values, rel=1e-10, abs=1e-12)


def test_compensator_and_statuses(paper: fb.Plant, paper_pose: fb.Pose) -> None:
    """At the design pose w = 0 under E; where M - E is indefinite and where the arm is stretched the status says so."""
    E = fb.design(paper_pose, method="exact", natural_frequency=346.8).E
    joints = np.column_stack([paper_pose.q[1:], [0.3, 0.0], [0.5, 2.0]])
    found = compiled(question_of(paper, E=3.0 * E)).run(joints)
    assert list(found.status)[:2] == [3, 2]
    assert np.isnan(found.values["robustness"][0, 0])
    assert abs(compiled(question_of(paper, E=E)).run(joints).values["robustness"][0, 0]) < 1e-14


def test_slow_measures_are_the_full_loop(paper: fb.Plant) -> None:
    """Rightmost pole of the reduced loop against the full 2N state space: equal where the task holds the whole arm."""
    joints = poses(paper, 4)[:, :25]
    slow = tuple(MEASURES[name] for name in ("closed_loop_abscissa", "highest_gain"))
    found = Engine(Formula(paper.arm, slow, (0, 1), (0.0, 0.0))).run(joints)
    gains = paper.arm.gains
    assert gains is not None
    for cell in np.flatnonzero(found.status == OK):
        system = fb.linearise(paper.at(joints[:, cell]))

        def rightmost(scale: float, system: fb.SecondOrder = system) -> float:
            return abscissa(close_loop(system, fb.Gains(scale * gains.stiffness, np.sqrt(scale) * gains.damping)))

        assert found.values["closed_loop_abscissa"][cell] == pytest.approx(rightmost(1.0), rel=1e-6, abs=1e-6)
        highest = found.values["highest_gain"][cell]
        if 0.0 < highest < np.inf:  # bisected to 1.5e-4
            assert rightmost(highest * 0.999) < 0.0 < rightmost(highest * 1.001)


def test_exact_design_measures_are_the_design(paper: fb.Plant) -> None:
    """||E||_F and rho of `design(method="exact")`, which computes with NumPy's eigenvalues; infeasible where it is."""
    joints = poses(paper, 5)
    found = compiled(question_of(paper)).run(joints)
    feasible = 0
    for cell in range(POSES):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", fb.FlexbaseWarning)  # cautions about radius and gravity
                made = fb.design(paper.at(joints[:, cell]), method="exact")
        except fb.Infeasible:
            assert found.status[cell] == 4
            continue
        feasible += 1
        assert found.values["exact_gain"][cell] == pytest.approx(np.linalg.norm(made.E), rel=1e-8)
        radius = made.certificate.algebraic_loop_radius
        assert found.values["exact_radius"][cell] == pytest.approx(radius, rel=1e-8)
    assert 5 < feasible < POSES


def test_a_formula_can_be_sent_to_another_process(paper: fb.Plant) -> None:
    """Measures by their names, the rest by value: the recipe is the same."""
    sent = Formula(paper.arm, tuple(fb.MEASURES.values()), (0, 1), (0.0, 0.0), ("payload",), 0.1 * np.eye(2))
    got = pickle.loads(pickle.dumps(sent))
    assert all(one is other for one, other in zip(got.measures, sent.measures, strict=True))
    assert got.recipe == sent.recipe
