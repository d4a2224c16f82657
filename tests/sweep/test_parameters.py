"""Parameters of a sweep against plants whose own arrays hold the same numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.model.base import make_base
from flexbase.sweeps.cells.parameters import configuration_of, parameters_of
from flexbase.sweeps.engine.evaluate import Engine, compiled
from flexbase.sweeps.engine.formula import Formula
from flexbase.trace.algebra import stack
from systems.changed import changed

VALUES = {
    "stiffness": 1.3,
    "damping": 0.4,
    "payload": 2.5,
    "link_mass": 1.1,
    "link_com": 0.9,
    "stiffness.{base}": 0.7,
    "damping.{base}": 1.6,
    "link_mass.{arm}": 1.25,
    "link_com.{arm}": 1.2,
}


@pytest.mark.parametrize("robot", ["ueda2003", "ur5e-gantry", "panda-platform"])
@pytest.mark.parametrize("pattern", VALUES)
def test_a_parameter_is_the_plants_own_number(robot: str, pattern: str) -> None:
    """M, Kp and Dp of a configuration under a parameter equal those of a plant built with it, to rounding."""
    plant = fb.load(robot)
    arm, names = plant.arm, plant.arm.mechanism.joint_names
    name, value = pattern.format(base=names[0], arm=names[arm.m + 1]), VALUES[pattern]
    assert name in parameters_of(arm)
    q = np.linspace(0.4, 0.9, arm.n)
    found = configuration_of(arm, tuple(q.tolist()), {name: value}, None)
    other = changed(plant, name, value)
    true = other.at(q).M
    assert stack(found.M) == pytest.approx(true, rel=1e-12, abs=1e-13 * np.abs(true).max())
    assert stack(found.stiffness) == pytest.approx(other.arm.base.stiffness, rel=1e-14)
    assert stack(found.damping) == pytest.approx(other.arm.base.damping, rel=1e-14)
    kind = name.partition(".")[0]
    before, after = (plant.arm.base, other.arm.base) if kind in ("stiffness", "damping") else (plant, other)
    changed_part = (lambda x: getattr(x, kind)) if kind in ("stiffness", "damping") else (lambda x: x.at(q).M)
    assert np.abs(changed_part(after) - changed_part(before)).max() > 1e-6 * np.abs(changed_part(before)).max()


def test_a_full_stiffness_matrix_stays_definite(paper: fb.Plant) -> None:
    """A factor on one joint of a coupled base scales its row and column by the root."""
    plant = fb.load("ur5e-gantry")
    arm = plant.arm
    m = arm.m
    assert m >= 2
    K = np.diag(np.arange(1.0, m + 1.0)) * 1e4
    K[0, 1] = K[1, 0] = 1.2e4
    coupled = fb.Plant(replace(arm, base=make_base(K, arm.base.damping, arm.base.equilibrium, m)))
    joints = (0.5,) * arm.n
    name = f"stiffness.{arm.mechanism.joint_names[0]}"
    found = stack(configuration_of(coupled.arm, joints, {name: 0.01}, None).stiffness)
    assert found[0, 0] == pytest.approx(100.0)
    assert found[0, 1] == found[1, 0] == pytest.approx(1.2e3)
    assert np.linalg.eigvalsh(found)[0] > 0.0


def test_all_parameters_compile_and_vary_a_sweep() -> None:
    """Kernel and rows agree with every parameter as input, and a map takes a joint's own as an axis."""
    plant = fb.load("ueda2003")
    names = tuple(parameters_of(plant.arm))
    assert names[5:] == ("stiffness.q1", "damping.q1", "link_mass.q2", "link_mass.q3", "link_com.q2", "link_com.q3")
    question = Formula(plant.arm, (fb.MEASURES["frequency"],), (0, 1), (0.0, 0.0), names)
    inputs = np.random.default_rng(0).uniform(0.5, 1.5, (2 + len(names), 50))
    rows, kernel = Engine(question).run(inputs), compiled(question).run(inputs)
    assert kernel.values["frequency"] == pytest.approx(rows.values["frequency"], rel=1e-12)
    chart = fb.sweep(plant, ["frequency"], fb.Cells(shape=(5, 5), vary={"stiffness.q1": (1.0, 4.0, 2)}))
    soft, stiff = chart.frequency.values
    known = np.isfinite(soft)
    assert known.any()
    assert stiff[known] == pytest.approx(2.0 * soft[known], rel=1e-12)


def test_an_unknown_parameter_is_named(paper: fb.Plant) -> None:
    with pytest.raises(fb.InputError, match=r'no parameter "stiffness\.q2".*stiffness\.q1'):
        fb.sweep(paper, cells=fb.Cells(shape=(3, 3), vary={"stiffness.q2": (0.5, 1.5, 3)}))
    with pytest.raises(fb.InputError, match=r"stiffness\.q1 from 0 to 1"):
        fb.sweep(paper, cells=fb.Cells(shape=(3, 3), vary={"stiffness.q1": (0.0, 1.0, 3)}))
