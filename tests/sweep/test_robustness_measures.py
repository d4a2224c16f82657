"""Shortage, the radius of a given gain's loop, and designs kept while the plant varies: against full models."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.linear.margins import algebraic_loop_radius
from flexbase.measures import MEASURES, Configuration
from flexbase.model.base import make_base
from flexbase.model.loop import Gain
from flexbase.model.parts import base_first
from flexbase.sweeps.engine.evaluate import compiled
from flexbase.sweeps.engine.formula import Formula
from flexbase.sweeps.engine.status import INFEASIBLE, OK
from systems.changed import changed


def asked(plant: fb.Plant, names: tuple[str, ...], **more: object) -> Formula:
    measures = tuple(MEASURES[name] for name in names)
    n = plant.arm.n
    return Formula(plant.arm, measures, tuple(range(n)), (0.0,) * n, **more)  # type: ignore[arg-type]


def undamped(plant: fb.Plant) -> fb.Plant:
    base = plant.arm.base
    return fb.Plant(replace(plant.arm, base=make_base(base.stiffness, 0.0 * base.damping, base.equilibrium, base.m)))


@pytest.mark.parametrize("robot", ["ueda2003", "ur5e-gantry", "iiwa-platform"])
def test_shortage_is_that_of_the_worst_mode(robot: str) -> None:
    """Residues R_i = a b^T of `fb.modes`, which solves the quadratic eigenproblem: (1 - tr R/|R|_F)/2, to 1e-6.

    Modes of which rounding alone is seen are left out by the reduced form's own size.
    """
    plant = undamped(fb.load(robot))
    joints = np.random.default_rng(1).uniform(-2.0, 2.0, (plant.arm.n, 12))
    found = compiled(asked(plant, ("shortage",))).run(joints)
    judged = 0
    for cell in np.flatnonzero(found.status == OK):
        residues = [mode.residue for mode in fb.modes(plant.at(joints[:, cell])).modes]
        sizes = [np.linalg.norm(R) for R in residues]
        missing = [0.5 * (1.0 - np.trace(R) / s) for R, s in zip(residues, sizes, strict=True) if s > 1e-9 * max(sizes)]
        assert found.values["shortage"][cell] == pytest.approx(max(missing), abs=1e-6)
        judged += max(missing) > 1e-3
    assert judged > 3


def test_a_mode_that_the_tip_does_not_see_harms_nothing(paper_pose: fb.Pose) -> None:
    """A second base joint, coupled to nothing but for rounding: its a and b are of size 1e-16 and at any angle."""
    pose, random = paper_pose, np.random.default_rng(2)
    alone = 0.5 * (1.0 - fb.modes(pose).modes[0].alignment)
    hidden = []
    for _ in range(20):
        M, J = np.zeros((4, 4)), np.zeros((2, 4))
        M[np.ix_([0, 2, 3], [0, 2, 3])], J[:, [0, 2, 3]] = pose.M, pose.J
        M[1, [0, 2, 3]] = M[[0, 2, 3], 1] = 1e-16 * random.normal(size=3)
        M[1, 1], J[:, 1] = 10.0, 1e-16 * random.normal(size=2)
        springs = ((pose.K[0, 0], 0.0), (0.0, 1e6))
        found = Configuration(M.tolist(), J.tolist(), base_first(2, len(M)), springs, ((0.0, 0.0), (0.0, 0.0)))
        assert MEASURES["shortage"].run(found) == pytest.approx(alone, abs=1e-12)
        hidden.append(max(0.5 * (1.0 - MEASURES["alignment"].run(mode)) for mode in found.modes))
    assert max(hidden) > alone + 0.1  # without the exception it would count


@pytest.mark.parametrize("robot", ["ueda2003", "ur5e-gantry", "panda-platform"])
def test_radius_of_a_given_gain(robot: str) -> None:
    """rho(Ms^-1 E) by LAPACK's general eigenvalues, to 1e-9; without a gain it is 0."""
    plant = fb.load(robot)
    n = plant.arm.n
    random = np.random.default_rng(3)
    half = random.normal(size=(n, n))
    E = 1e-3 * np.eye(n) - 0.05 * half @ half.T
    joints = random.uniform(-2.0, 2.0, (n, 20))
    found = compiled(asked(plant, ("algebraic_loop_radius",), E=E)).run(joints)
    good = np.flatnonzero(found.status == OK)
    assert good.size > 3
    for cell in good:
        true = algebraic_loop_radius(plant.at(joints[:, cell]), E)
        assert found.values["algebraic_loop_radius"][cell] == pytest.approx(true, rel=1e-9)
    none = compiled(asked(plant, ("algebraic_loop_radius",))).run(joints)
    assert np.all(none.values["algebraic_loop_radius"][none.status == OK] == 0.0)


def test_the_design_of_each_cell_is_kept_while_the_plant_varies(paper: fb.Plant) -> None:
    """E of `fb.design` at the nominal pose, in a plant built with a payload: frequency and w, to 1e-8."""
    joints = np.random.default_rng(5).uniform(-2.0, 2.0, (2, 40))
    question = asked(paper, ("frequency", "robustness"), parameters=("payload",), redesigned=True)
    found = compiled(question).run(np.vstack([joints, np.full(40, 2.0)]))
    heavier = changed(paper, "payload", 2.0)
    judged = infeasible = 0
    for cell in range(40):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", fb.FlexbaseWarning)  # an algebraic loop of radius 1 and more
                E = fb.design(paper.at(joints[:, cell]), method="exact").E
        except fb.Infeasible:
            assert found.status[cell] == INFEASIBLE
            infeasible += 1
            continue
        pose = heavier.at(joints[:, cell])
        if found.status[cell] != OK:
            assert np.linalg.eigvalsh(pose.M[1:, 1:] - E)[0] <= 0.0 or np.linalg.det(pose.M) <= 0.0
            continue
        mode = fb.modes(pose, Gain(E)).modes[0]
        assert found.values["frequency"][cell, 0] == pytest.approx(mode.frequency, rel=1e-8)
        assert found.values["robustness"][cell, 0] == pytest.approx(mode.robustness, rel=1e-7, abs=1e-12)
        judged += 1
    assert judged > 5
    assert infeasible > 0
