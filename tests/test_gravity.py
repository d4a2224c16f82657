"""Gravity: static sag, gravity stiffness, poses and modes under it.  [theory §1]"""

from __future__ import annotations

import numpy as np
import pytest

import flexbase
from flexbase import FlexbaseWarning, InputError
from flexbase.dynamics.statics import gravity_stiffness
from systems.oracle import FullSystem, rigid_bodies
from systems.planar import planar
from systems.random_plants import random_pose

DOWN = (0.0, -9.81, 0.0)
POSES = [(seed, m, n) for seed in range(3) for m, n in [(1, 2), (2, 3), (3, 4)]]


@pytest.mark.parametrize(("seed", "m", "n"), POSES)
def test_sagged_base_is_in_balance(seed, m, n):
    """Kp (qbar - q_p) = g_p(q), with g from Pinocchio, to 1e-12 of the gravity forces."""
    pose = random_pose(seed, m, n, 2, gravity=True)
    pull = rigid_bodies(pose).gravity(pose.q)
    spring = pose.arm.base.stiffness @ (pose.equilibrium - pose.q[:m])
    assert np.abs(pull[:m]).max() > 1e-3 * np.abs(pull).max()  # there is something to hold
    assert spring == pytest.approx(pull[:m], rel=0.0, abs=1e-11 * np.abs(pull).max())
    assert pose.holding_torque == pytest.approx(pull[m:], rel=0.0, abs=1e-11 * np.abs(pull).max())


def test_sag_of_a_vertical_spring_is_weight_over_stiffness():
    """A base sliding along y under an arm of known mass sinks by (8 + 7 + 6) g / K, at any pose."""
    plant = planar([0.0, 0.4, 0.3], slide=(0,), axes={0: (0.0, 1.0)}, gravity=DOWN, stiffness=2e4)
    for q in ([0.3, 0.5], [1.0, -1.2]):
        assert plant.at(q).q[0] == pytest.approx(-21.0 * 9.81 / 2e4, rel=1e-13)


@pytest.mark.parametrize(("seed", "m", "n"), POSES)
def test_gravity_stiffness_is_the_slope_of_gravity(seed, m, n):
    """dg/dq equals Pinocchio's derivative to 1e-10, and central differences of Pinocchio's g to 1e-7."""
    pose = random_pose(seed, m, n, 2, gravity=True)
    bodies, ours = rigid_bodies(pose), gravity_stiffness(pose.arm, pose.q)
    slopes = bodies.gravity_slope(pose.q)
    assert ours == pytest.approx(slopes, rel=0.0, abs=1e-10 * np.abs(slopes).max())
    step = 1e-5 * np.eye(m + n)
    differences = [(bodies.gravity(pose.q + d) - bodies.gravity(pose.q - d)) / 2e-5 for d in step]
    assert ours == pytest.approx(np.array(differences).T, rel=0.0, abs=1e-7 * np.abs(slopes).max())


@pytest.mark.parametrize("slide", [(), (0,)])
@pytest.mark.parametrize(
    ("rows", "lengths", "target"),
    [
        (("x", "y"), [0.2, 0.3, 0.25], [0.4, -0.2]),
        (("x", "y", "rz"), [0.2, 0.3, 0.25, 0.2], [0.5, 0.2, 0.8]),
        (("x", "y"), [0.2, 0.3, 0.25, 0.2], [0.5, 0.3]),
    ],
)
@pytest.mark.parametrize("stiffness", [3e3, 3e5])
def test_sagged_tip_is_on_target(rows, lengths, target, slide, stiffness):
    """at_tip under gravity: the tip lands on the target after the base has sagged, to 1e-10 m.

    The witness is Pinocchio's forward kinematics; the sag itself must be far larger than the tolerance.
    """
    plant = planar(lengths, rows=rows, gravity=DOWN, stiffness=stiffness, slide=slide, axes={0: (0.0, 1.0)})
    pose = plant.at_tip(target)
    rotation, position = rigid_bodies(pose).tool_pose(pose.q)
    reached = [position[0], position[1], np.arctan2(rotation[1, 0], rotation[0, 0])][: len(target)]
    assert abs(pose.q[0]) > 1e-6
    assert reached == pytest.approx(target, abs=1e-10)
    assert pose.tip == pytest.approx(target, abs=1e-10)


def test_a_base_too_soft_for_gravity_is_refused():
    """A torsion spring that cannot hold the arm upright has no rest there: one InputError with the mend."""
    plant = planar([0.5, 0.5, 0.5], gravity=(-9.81, 0.0, 0.0), stiffness=1.0)
    with pytest.raises(InputError, match=r"does not hold the arm against gravity.*Give a stiffer base"):
        plant.at([0.1, 0.5])


@pytest.mark.parametrize("damping", ["proportional", "full"])
@pytest.mark.parametrize(("seed", "m", "n"), [(seed, m, n) for seed, m, n in POSES if seed < 2])
def test_modes_under_gravity_are_poles_of_the_full_system(seed, m, n, damping):
    """Each mode's frequency and damping equal a pole of the 2N system assembled from Pinocchio, to 1e-9.

    Its residue equals Cauchy's integral of P around that pole.
    """
    pose = random_pose(seed, m, n, 2, damping=damping, gravity=True)
    system, found = FullSystem(pose), flexbase.modes(pose)
    poles = system.poles()
    assert len(found) == m
    for mode in found:
        pole = mode.frequency * complex(-mode.damping_ratio, np.sqrt(1.0 - mode.damping_ratio**2))
        nearest = poles[np.argmin(np.abs(poles - pole))]
        assert abs(nearest - pole) < 1e-9 * abs(pole)
        R = system.mode_residue(nearest)
        assert mode.residue == pytest.approx(R, rel=0.0, abs=1e-8 * np.abs(R).max())
    assert "Gravity" in found.caveat


def test_modes_under_vanishing_gravity_are_those_without():
    """As gravity goes to zero, the full path meets the reduced form, and the gap shrinks in proportion to gravity.

    At 1e-3 m/s^2, gravity's stiffness is 1e-7 of the base's, so residues agree to 1e-5; a tenfold gravity must make a
    tenfold gap (within a factor 1.5: rounding of the eigenvectors is 1e-9).
    """
    free = flexbase.modes(planar([0.2, 0.1, 0.3, 0.25], m=2).at([0.4, 0.9]))
    gaps = []
    for size in (1e-2, 1e-3):
        under = flexbase.modes(planar([0.2, 0.1, 0.3, 0.25], m=2, gravity=(0.0, -size, 0.0)).at([0.4, 0.9]))
        gaps.append(
            [
                *(abs(a.frequency / b.frequency - 1.0) for a, b in zip(under.modes, free.modes, strict=True)),
                *(np.abs(a.residue - b.residue).max() for a, b in zip(under.modes, free.modes, strict=True)),
                np.abs(under.rigid_mode - free.rigid_mode).max(),
            ]
        )
    assert max(gaps[1]) < 1e-5
    assert np.array(gaps[0]) / np.array(gaps[1]) == pytest.approx(np.full(len(gaps[0]), 10.0), rel=0.5)


@pytest.mark.parametrize("method", sorted(flexbase.METHODS))
def test_design_under_gravity_warns_and_its_certificate_includes_gravity(method):
    """The methods leave gravity stiffness out of their equations and say so; the certificate is still the truth.

    Its frequency equals a pole of the full system under gravity, and differs from the one without (the control).
    """
    pose = planar([0.2, 0.3, 0.25], gravity=(0.0, -2000.0, 0.0), stiffness=1e5).at([0.4, 0.9])
    options = {"natural_frequency": 1.3 * flexbase.modes(pose)[0].frequency} if method != "bounded" else {}
    with pytest.warns(FlexbaseWarning) as said:
        compensator = flexbase.design(pose, method, **options)
    assert any("gravity" in str(warning.message) for warning in said)
    claimed = compensator.certificate.frequency_after_rad_s[0]
    system = FullSystem(pose, compensator.E)
    assert np.abs(np.abs(system.poles()) / claimed - 1.0).min() < 1e-9
    system.K[:] = 0.0
    system.K[0, 0] = pose.arm.base.stiffness[0, 0]
    assert np.abs(np.abs(system.poles()) / claimed - 1.0).min() > 1e-5
