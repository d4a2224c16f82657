"""The frozen model: bodies welded together, bases, gains, and the checks that public functions make."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin
import pytest

import flexbase
from flexbase import FlexbaseWarning, InputError
from flexbase.checks import check_length, choose, finite_array
from flexbase.model.base import make_base
from flexbase.model.mechanism import Body, merged, with_payload
from flexbase.model.task import Task, make_gains
from systems.oracle import RigidBodies
from systems.planar import planar
from systems.random_plants import random_inertia, random_mechanism


def random_body(seed):
    rng = np.random.default_rng(seed)
    return Body(rng.uniform(0.5, 3.0), rng.normal(size=3), random_inertia(rng))


@pytest.mark.parametrize("seed", range(4))
def test_welded_bodies_are_pinocchios_sum(seed):
    """Mass, centre of mass and inertia of two bodies in one, to 1e-13."""
    one, other = random_body(seed), random_body(seed + 100)
    total = pin.Inertia(*one) + pin.Inertia(*other)
    ours = merged(one, other)
    assert ours.mass == pytest.approx(total.mass, rel=1e-14)
    assert ours.com == pytest.approx(total.lever, rel=1e-13)
    assert ours.inertia == pytest.approx(total.inertia, rel=1e-12, abs=1e-13)


def test_payload_is_a_body_at_the_tool():
    """The loaded arm's inertia is the arm's plus that of a body that Pinocchio fixes at the tool frame, to 1e-12."""
    rng = np.random.default_rng(3)
    bare, load = random_mechanism(rng, 4, payload=False), random_body(9)
    oracle = RigidBodies(bare)
    tool = pin.SE3(bare.tool_rotation, bare.tool_position)
    oracle.model.appendBodyToJoint(4, pin.Inertia(*load), tool)
    oracle.data = oracle.model.createData()
    q = rng.normal(size=4)
    loaded = RigidBodies(with_payload(bare, load)).inertia(q)
    assert loaded == pytest.approx(oracle.inertia(q), rel=1e-11, abs=1e-12)
    assert not np.allclose(loaded, RigidBodies(bare).inertia(q))


def test_a_payload_leaves_the_bare_arm_as_it_was():
    """with_payload returns another mechanism: frozen data is not changed behind its owner's back."""
    bare = random_mechanism(np.random.default_rng(4), 3, payload=False)
    mass, com, inertia = bare.mass.copy(), bare.com.copy(), bare.inertia.copy()
    with_payload(bare, random_body(1))
    assert np.array_equal(bare.mass, mass)
    assert np.array_equal(bare.com, com)
    assert np.array_equal(bare.inertia, inertia)


def test_vectors_become_diagonal_matrices():
    """Stiffness and damping of a base, gains of a task: a vector is the diagonal of a matrix."""
    base = make_base([1.0, 2.0], [0.0, 3.0], [0.1, 0.2], 2)
    assert np.array_equal(base.stiffness, np.diag([1.0, 2.0]))
    assert np.array_equal(base.damping, np.diag([0.0, 3.0]))
    gains = make_gains([5.0], [[2.0]], 1)
    assert gains.stiffness.tolist() == [[5.0]]
    assert gains.damping.tolist() == [[2.0]]


@pytest.mark.parametrize(
    ("stiffness", "damping", "message"),
    [
        ([1.0], [0.0, 0.0], "stiffness: 1 values? given, 2 needed"),
        ([0.0, 1.0], [0.0, 0.0], "stiffness: 0 .*Give a positive number"),
        ([-1.0, 1.0], [0.0, 0.0], "stiffness: -1 .*leaves the base no equilibrium"),
        ([[1.0, 2.0], [2.0, 1.0]], [0.0, 0.0], "stiffness: smallest eigenvalue -1 .*Give a positive definite"),
        ([[1.0, 0.5], [0.0, 1.0]], [0.0, 0.0], r"not symmetric, entry \(1,2\) is 0.5"),
        ([[1.0, 0.5]], [0.0, 0.0], r"shape \(1, 2\) given"),
        ([1.0, 1.0], [-1.0, 0.0], "damping: -1 .*feed energy"),
        ([1.0, 1.0], [[0.0, 1.0], [1.0, 0.0]], "damping: smallest eigenvalue -1"),
        ([np.nan, 1.0], [0.0, 0.0], "not finite"),
        (["a", 1.0], [0.0, 0.0], "not an array of numbers"),
    ],
)
def test_impossible_bases_are_refused(stiffness, damping, message):
    """Count, sign, symmetry, definiteness, finiteness: each fault by name, value and mend."""
    with pytest.raises(InputError, match=message):
        make_base(stiffness, damping, [0.0, 0.0], 2)


def test_a_semidefinite_damping_is_legal():
    """Damping may vanish in a direction, even when rounding makes its eigenvalue -1e-17."""
    direction = np.array([0.1, 0.3])
    assert make_base([1.0, 1.0], np.outer(direction, direction), [0.0, 0.0], 2).m == 2


def test_checked_arrays_are_read_only():
    """What a check returns cannot be written to, and is a copy: the caller's own array stays his."""
    mine = np.array([1.0, 2.0])
    checked = check_length("x", mine, 2, "two")
    with pytest.raises(ValueError, match="read-only"):
        checked[0] = 5.0
    mine[0] = 7.0
    assert checked[0] == 1.0


@pytest.mark.parametrize(
    "value",
    [[1.0, np.inf], [np.nan], "text", [[1.0], [1.0, 2.0]], None, [10**400]],
    ids=["infinite", "nan", "text", "ragged", "nothing", "huge integer"],
)
def test_only_finite_numbers_pass(value):
    """Infinity, NaN, text, ragged lists, nothing at all, an integer beyond doubles: InputError, never another error."""
    with pytest.raises(InputError, match="x: "):
        finite_array("x", value)


def test_an_unknown_choice_names_the_nearest():
    """A misspelt name gets the nearest valid one; a strange one the list."""
    with pytest.raises(InputError, match='Did you mean "recursive"'):
        choose("method", "recursve", {"recursive": 1, "exact": 2})
    with pytest.raises(InputError, match="Valid: recursive, exact"):
        choose("method", "zzz", {"recursive": 1, "exact": 2})


def test_data_is_frozen(paper):
    """No field of arm, base or task can be replaced in place."""
    for thing in (paper, paper.arm, paper.arm.base, paper.arm.mechanism, paper.arm.task):
        name = dataclasses.fields(thing)[0].name
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(thing, name, None)


def test_task_rows_know_their_places_and_units():
    """Rows index x y z rx ry rz in task order, and carry m or rad."""
    task = Task(("y", "rz", "x"))
    assert task.indices == (1, 5, 0)
    assert task.units == ("m", "rad", "m")


def test_an_ill_conditioned_inertia_warns():
    """Condition number of M above 1e12: accepted with a warning. A massless inertia cannot be written at all."""
    plant = planar([1e-7, 0.3, 0.25], m=1)
    mechanism = dataclasses.replace(plant.arm.mechanism, mass=np.array([2e15, 7.0, 6.0]))
    heavy = dataclasses.replace(plant, arm=dataclasses.replace(plant.arm, mechanism=mechanism))
    with pytest.warns(FlexbaseWarning, match="condition number of M"):
        heavy.at([0.4, 0.9])


def test_a_massless_direction_is_refused():
    """An inertia matrix that is not positive definite: InputError with its eigenvalue and the mend."""
    plant = planar([0.2, 0.3, 0.25])
    mechanism = plant.arm.mechanism
    inertia, com = mechanism.inertia.copy(), mechanism.com.copy()
    inertia[2], com[2] = 0.0, 0.0
    empty = dataclasses.replace(mechanism, inertia=inertia, com=com)
    arm = dataclasses.replace(plant.arm, mechanism=empty)
    with pytest.raises(InputError, match=r"inertia matrix.*is not positive definite"):
        dataclasses.replace(plant, arm=arm).at([0.4, 0.9])


def test_right_angles_of_a_file_are_literal_zeros():
    """A URDF's 1.5707963267948966 leaves 2e-16 in a rotation: dropped, so it costs nothing in a traced program."""
    mechanism = flexbase.load("panda-gantry").arm.mechanism
    raw = np.abs(mechanism.placement_rotation)
    kept = np.abs([link.placement_rotation for link in mechanism.links])
    assert np.any((raw > 0.0) & (raw < 1e-15))  # the file has such entries
    assert not np.any((kept > 0.0) & (kept < 1e-15))
    np.testing.assert_allclose(kept, raw, rtol=0.0, atol=1e-15)
