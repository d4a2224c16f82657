"""Task rows on an arm that turns freely: any choice of rows has an error of zero at rest, and J is its slope."""

from __future__ import annotations

import dataclasses
import itertools

import numpy as np
import pytest

import flexbase
from flexbase import FlexbaseWarning, InputError, Plant
from flexbase.model.task import ROWS, Task

JOINTS = [0.3, -1.2, 1.4, -1.5, -1.4, 0.2]
SUBSETS = [rows for count in (1, 2, 3, 6) for rows in itertools.combinations(ROWS, count)]


@pytest.fixture(scope="module")
def ur5e():
    return flexbase.load("ur5e-pedestal")


@pytest.mark.parametrize("rows", SUBSETS, ids=" ".join)
def test_error_is_zero_at_rest_and_its_slope_is_the_jacobian(ur5e, rows):
    """Central differences of the tip error, step 1e-6: truncation and rounding stay below 1e-8."""
    pose = Plant(dataclasses.replace(ur5e.arm, task=Task(rows), gains=None)).at(JOINTS)
    assert pose.tip_error(pose.q) == pytest.approx(np.zeros(len(rows)), abs=1e-12)
    steps = 1e-6 * np.eye(pose.arm.N)
    slope = np.array([(pose.tip_error(pose.q + step) - pose.tip_error(pose.q - step)) / 2e-6 for step in steps]).T
    assert slope == pytest.approx(pose.J, abs=1e-8)
    assert np.abs(pose.J).max() > 1e-2  # a slope of zeros would fail


def test_the_one_angle_of_a_scara_is_met():
    """Its axes are parallel, so rz is the angle itself."""
    scara = flexbase.load("scara")
    target = scara.at([0.4, 0.9, 0.05, 0.3]).tip
    assert scara.at_tip(target).tip == pytest.approx(target, abs=1e-10)


def test_six_rows_are_met_near_half_a_turn(ur5e):
    """Rotation by nearly pi: the pose is found again, its error measured by log(R Rd^T)."""
    plant = Plant(dataclasses.replace(ur5e.arm, task=Task(ROWS), gains=None))
    pose = plant.at(JOINTS)
    turned = pose.tip.copy()
    turned[3:] *= (np.pi - 1e-6) / np.linalg.norm(turned[3:])
    found = plant.at_tip(turned)
    assert np.linalg.norm(found.tip[3:]) == pytest.approx(np.pi - 1e-6, abs=1e-9)
    assert found.tip[:3] == pytest.approx(turned[:3], abs=1e-10)


def test_a_method_is_chosen_that_knows_the_options(ur5e):
    """Left out: convex for two base joints; an option that only the recursions know picks one of those."""
    pose = ur5e.at([-0.652, -0.863, 0.53, -0.368, 1.309, 0.911])
    with pytest.warns(FlexbaseWarning, match="redundant"):
        assert flexbase.design(pose, radius=0.5).method == "convex"
    with pytest.raises(InputError, match=r"recursive: 2 base joints"):
        flexbase.design(pose, derivatives="exact")
    with pytest.raises(InputError, match=r"Make one with plant\.at"):
        flexbase.design(ur5e)


def test_one_beta_decides_the_verdict_at_any_damping():
    """An aligned design on a base with non-proportional damping is called positive real, and its response agrees."""
    gantry = flexbase.load("ur5e-gantry")
    pose = gantry.at_tip([0.5, 0.2, 0.6])
    with pytest.warns(FlexbaseWarning, match="redundant"):
        found = flexbase.design(pose, "convex", objective="aligned")
    modes = flexbase.modes(pose, found)
    assert modes.positive_real
    assert "one beta" in modes.caveat
    omega = np.geomspace(10.0, 2000.0, 400)
    G = 1j * omega[:, None, None] * flexbase.linearise(pose, found).transfer_function(1j * omega)
    hermitian = np.linalg.eigvalsh(G + np.conj(np.swapaxes(G, -1, -2)))
    assert hermitian.min() > -1e-8 * np.abs(G).max()
    assert not flexbase.modes(pose).positive_real  # the control: without E


def test_a_joint_map_of_a_scara_shows_something():
    """Prismatic axes span the reach, not pi; the joints outside the map are bent, so that cells can be judged."""
    scara = flexbase.load("scara")
    chart = flexbase.sweep(scara, cells=flexbase.Cells(over="joints", shape=(12, 12)))
    assert chart["status"].dims == ("elbow", "shoulder")
    assert np.isfinite(chart["robustness"].values).mean() > 0.8
    lift = flexbase.sweep(scara, cells=flexbase.Cells(over="joints", shape=(5, 5), axes=("elbow", "lift")))["lift"]
    assert lift.attrs["units"] == "m"
    assert lift.values.max() < 1.5
