"""The bounded design: its parametrisation, its slopes, and how far it gets.  [theory §7]"""

from __future__ import annotations

import sys
import warnings

import numpy as np
import pytest

import flexbase
from flexbase import FlexbaseWarning, InputError
from flexbase.compensators.judge.gain_shortage import relative_shortage, working_damping
from flexbase.compensators.judge.implementable import BoundedGain
from flexbase.compensators.search.descent import descend, shortage_and_slope
from flexbase.model.loop import Gain
from systems.oracle import FullSystem
from systems.passivity import loop_radius, passivity
from systems.planar import planar
from systems.random_plants import random_pose
from systems.six_joint import random_poses, six_joint

SIZES = [(1, 2, 2), (1, 4, 2), (2, 3, 2), (2, 5, 5), (3, 4, 3), (3, 6, 1)]


def solve(pose, **options):
    """The design; its warnings are checked where they matter."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlexbaseWarning)
        return flexbase.design(pose, "bounded", **options)


def random_symmetric(rng, n, size=1.0):
    root = size * rng.normal(size=(n, n))
    return root + root.T


@pytest.mark.parametrize("size", [0.01, 1.0, 100.0])
def test_every_parameter_gives_an_implementable_gain(size):
    """rho < g, X > 0 and S > 0 for free symmetric W however large; the map and its inverse agree to 1e-9."""
    rng = np.random.default_rng(0)
    for seed in range(10):
        pose = random_pose(seed, 2, 5, 3)
        gain, W = BoundedGain(pose, 0.7), random_symmetric(rng, 5, size)
        E = gain.at(W)[0]
        assert loop_radius(pose, E) < 0.7
        assert np.linalg.eigvalsh(FullSystem(pose, E).M)[0] > 0.0
        if size < 100.0:  # beyond, the square root has lost W's digits
            assert gain.parameter(E, 1.0) == pytest.approx(W, rel=0.0, abs=1e-6 * np.abs(W).max())


@pytest.mark.parametrize("damping", ["proportional", "full", "zero", "overdamped"])
@pytest.mark.parametrize("size", SIZES, ids=str)
def test_slopes_equal_finite_differences(size, damping):
    """dJ/dE along random directions, and dJ/dW through the parametrisation, to 1e-5 of their size.

    Central differences of step 1e-5 of the inertia: their own error is near 1e-8 for a smooth function.
    """
    rng = np.random.default_rng(1)
    for seed in range(3):
        pose = random_pose(seed, *size, damping=damping)
        n, gain = size[1], BoundedGain(pose, 0.9)
        W = random_symmetric(rng, n)
        E, vectors, angles = gain.at(W)
        slope = shortage_and_slope(pose, E)[1]
        in_W = gain.pull_back(slope, vectors, angles)
        scale = np.linalg.eigvalsh(FullSystem(pose).M)[0]
        for _ in range(4):
            direction = random_symmetric(rng, n)
            step = 1e-5 * scale * direction
            ahead, behind = (shortage_and_slope(pose, E + sign * step)[0] for sign in (1.0, -1.0))
            size_of_slope = np.linalg.norm(slope) * np.linalg.norm(direction)
            assert (ahead - behind) / (2e-5 * scale) == pytest.approx(
                np.sum(slope * direction), abs=1e-5 * size_of_slope
            )
            ahead, behind = (
                shortage_and_slope(pose, gain.at(W + sign * 1e-5 * direction)[0])[0] for sign in (1.0, -1.0)
            )
            size_of_slope = np.linalg.norm(in_W) * np.linalg.norm(direction)
            assert (ahead - behind) / 2e-5 == pytest.approx(np.sum(in_W * direction), abs=1e-5 * size_of_slope)


@pytest.mark.parametrize("size", [(1, 3, 3), (2, 4, 3), (3, 5, 2)], ids=str)
def test_the_objective_is_the_sum_of_the_modes(size):
    """-sum w_i / (4 zeta_i omega_i) of the modes that `modes` finds, for proportional damping, to 1e-9."""
    for seed in range(5):
        pose = random_pose(seed, *size, damping="proportional")
        E = BoundedGain(pose, 0.8).at(random_symmetric(np.random.default_rng(seed), size[1]))[0]
        found = flexbase.modes(pose, Gain(E)).modes
        total = -sum(mode.robustness / (4.0 * mode.damping_ratio * mode.frequency) for mode in found)
        assert shortage_and_slope(pose, E)[0] == pytest.approx(total, rel=1e-9)


def test_the_shortage_of_one_mode_is_the_frequency_response(paper_pose):
    """m = 1: the sweep's least eigenvalue is w/(4 zeta omega), and (1 - cos)/2 of the largest response.  [theory §4]"""
    none = np.zeros((2, 2))
    mode = flexbase.modes(paper_pose)[0]
    assert relative_shortage(paper_pose, none) == pytest.approx(0.28645, abs=1e-5)  # theory §5's check case
    assert relative_shortage(paper_pose, none) == pytest.approx(0.5 * (1.0 - mode.alignment), rel=1e-4)
    assert shortage_and_slope(paper_pose, none)[0] == pytest.approx(0.001383691, abs=1e-9)


@pytest.mark.parametrize("base", [("px", "py", "rz"), ("rx", "ry", "rz"), ("px", "py", "pz")], ids=" ".join)
def test_three_base_joints_and_three_rows_become_positive_real(base):
    """Where one beta for all modes often has no gain under rho < 0.9: the brute-force sweep finds nothing missing.

    At most one of four poses may keep a shortage, and then its certificate says so; E = 0 lacks 1 % or more in each.
    """
    complete = 0
    for pose in random_poses(six_joint(base, 3), 4):
        found = solve(pose)
        assert loop_radius(pose, found.E) < 0.9
        lacks = -passivity(pose, found.E)
        complete += lacks < 1e-6
        assert any("not positive real" in text for text in found.certificate.warnings) == (lacks > 1e-6)
        assert passivity(pose, np.zeros((6, 6))) < -1e-2
    assert complete >= 3


@pytest.mark.slow
def test_six_rows_leave_a_fraction():
    """k = 6 on two- and three-joint bases: the shortage falls below a tenth, in the median below a fiftieth."""
    left = []
    for base in (("px", "py"), ("rx", "ry", "rz")):
        for pose in random_poses(six_joint(base, 6), 3):
            found = solve(pose)
            left.append(passivity(pose, found.E) / passivity(pose, np.zeros((6, 6))))
            assert loop_radius(pose, found.E) < 0.9
    assert max(left) < 0.1
    assert np.median(left) < 0.02


@pytest.mark.parametrize("size", [(1, 1, 1), (1, 3, 3), (2, 2, 2), (3, 7, 4), (4, 3, 2)], ids=str)
@pytest.mark.parametrize("damping", ["zero", "full", "overdamped"])
def test_it_never_leaves_more_missing_than_no_gain(size, damping):
    """Any sizes, any damping, the undamped base included: the response lacks no more, rho and M - E hold."""
    for seed in range(2):
        pose = random_pose(seed, *size, damping=damping)
        E = solve(pose).E
        assert relative_shortage(pose, E) <= relative_shortage(pose, np.zeros_like(E)) + 1e-9
        assert loop_radius(pose, E) < 0.9
        assert np.linalg.eigvalsh(FullSystem(pose, E).M)[0] > 0.0


def test_an_undamped_base_is_given_one_percent():
    """The fallback: 1 % of critical at the slowest mode of the base by itself, proportional to its stiffness."""
    pose = random_pose(0, 2, 3, 2, damping="zero")
    base, Mpp = pose.arm.base, FullSystem(pose).M[:2, :2]
    slowest = np.sqrt(np.linalg.eigvals(np.linalg.solve(Mpp, base.stiffness)).real.min())
    assert working_damping(pose) == pytest.approx(2.0 * 0.01 / slowest * base.stiffness, rel=1e-9)
    damped = random_pose(0, 2, 3, 2)
    assert working_damping(damped) is damped.arm.base.damping


def test_descent_ends_where_the_slope_vanishes():
    """k = 6, where something stays missing: the end is stationary, no random small step in W goes lower."""
    pose = random_poses(six_joint(("px", "py"), 6), 1)[0]
    value, E = descend(pose, 0.5, np.zeros((6, 6)))
    gain = BoundedGain(pose, 0.5)
    none = shortage_and_slope(pose, np.zeros((6, 6)))[0]
    assert 0.0 < value < 1.0
    rng = np.random.default_rng(0)
    W = gain.parameter(E, 1.0 - 1e-9)
    for _ in range(200):
        other = shortage_and_slope(pose, gain.at(W + random_symmetric(rng, 6, 1e-3))[0])[0] / none
        assert other >= value * (1.0 - 1e-3)


def test_the_seed_decides_and_the_extra_is_optional(paper_pose, monkeypatch):
    """The same seed gives the same E to the bit; without cvxpy the other two starts serve."""
    pose = random_pose(1, 2, 4, 3)
    assert np.array_equal(solve(pose, seed=3).E, solve(pose, seed=3).E)
    monkeypatch.setitem(sys.modules, "cvxpy", None)
    E = solve(paper_pose).E
    assert passivity(paper_pose, E) > -1e-8
    assert loop_radius(paper_pose, E) < 0.9


def test_scope_and_options_are_checked(paper_pose):
    """A rigid base, a radius out of range, and natural frequencies, which this method does not aim at."""
    with pytest.raises(InputError, match=r"radius: 1\.2 must be below 1"):
        solve(paper_pose, radius=1.2)
    with pytest.raises(InputError, match='"natural_frequency" is unknown'):
        solve(paper_pose, natural_frequency=300.0)
    with pytest.warns(FlexbaseWarning, match="no .base. joints"):
        rigid = planar([0.3, 0.25], m=0)
    with pytest.raises(InputError, match="rigid"):
        solve(rigid.at([0.4, 0.9]))
