"""The exact verdict against dense sweeps, closed forms and the residues of lossless plants.  [theory §5]"""

from __future__ import annotations

import json
from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.model.loop import Gain
from systems.dense_sweep import KINDS, Plant, grid, least_eigenvalue, lowest, random_plant, shortage_and_gain
from systems.oracle import FullSystem
from systems.passivity import passivity
from systems.planar import planar, sliding_pair
from systems.random_plants import random_pose

PAPER_E = Gain(np.array([[0.12, 0.079], [0.079, -0.15]]))
TOLERANCE = 1e-8  # of the largest gain: the verdict's own, and the accuracy that is promised


def system_of(plant: Plant) -> fb.SecondOrder:
    m, k = len(plant.S), len(plant.U)
    return fb.SecondOrder(plant.S, plant.D, plant.K, -plant.V.T, plant.U, ("q",) * m, ("f",) * k, ("y",) * k)


def plants(count: int, m: int = 3, k: int = 6):
    rng = np.random.default_rng(5)
    for i in range(count):
        yield random_plant(rng, int(rng.integers(1, m + 1)), int(rng.integers(1, k + 1)), KINDS[i % len(KINDS)])


def test_random_plants_against_a_dense_sweep():
    """120 plants, m to 3, k to 6, coupled damping: nu and the gain to 1e-8 of the gain, and the same yes or no.

    All thousand: benchmarks/verdicts.py. Both answers occur, the positive ones among the aligned plants.
    """
    answers = []
    for plant in plants(120):
        found = fb.verdict(system_of(plant))
        nu, gain = shortage_and_gain(plant.response, grid(plant.poles()))
        assert abs(found.shortage - nu) < TOLERANCE * gain
        assert found.largest_gain == pytest.approx(gain, rel=1e-8)
        assert found.positive_real == (nu >= -TOLERANCE * gain)
        assert found.positive_real == found.negative_imaginary
        assert not any("settle" in caveat for caveat in found.caveats)
        answers.append(found.positive_real)
    assert 25 < sum(answers) < 60


def test_six_base_joints_and_six_rows():
    """The largest plants that are read: the same property."""
    for seed, kind in enumerate(KINDS):
        plant = random_plant(np.random.default_rng(seed), 6, 6, kind)
        found = fb.verdict(system_of(plant))
        nu, gain = shortage_and_gain(plant.response, grid(plant.poles()))
        assert abs(found.shortage - nu) < TOLERANCE * gain
        assert found.positive_real == (nu >= -TOLERANCE * gain)


def test_intervals_are_where_it_fails():
    """Just inside every interval the least eigenvalue is below its level, the tolerance or half of nu; outside not."""
    several = 0
    for plant in plants(60):
        found = fb.verdict(system_of(plant))
        for intervals, level in (
            (found.fails_at, -TOLERANCE * found.largest_gain),
            (found.half_at, found.shortage / 2),
        ):
            ends = np.array(intervals).reshape(-1, 2)
            assert np.all(np.diff(ends.ravel()) > 0.0)
            assert (len(ends) == 0) == found.positive_real
            if found.positive_real:
                assert least_eigenvalue(plant.response, grid(plant.poles())).min() > -TOLERANCE * found.largest_gain
                continue
            for low, high in ends:
                inside = least_eigenvalue(plant.response, np.array([low * (1 + 1e-7), high * (1 - 1e-7)]))
                outside = least_eigenvalue(plant.response, np.array([low * (1 - 1e-7), high * (1 + 1e-7)]))
                assert np.all(inside < level + 1e-13 * found.largest_gain)
                assert np.all(outside > level - 1e-13 * found.largest_gain)
            omega = grid(plant.poles())
            below = least_eigenvalue(plant.response, omega) < level
            claimed = np.any((omega[:, None] > ends[:, 0]) & (omega[:, None] < ends[:, 1]), axis=1)
            near = np.any(np.abs(omega[:, None] / ends.ravel()[None, :] - 1.0) < 1e-6, axis=1)
            assert np.array_equal(below[~near], claimed[~near])
            several += len(ends) > 1
    assert several > 3


def test_finite_frequency_is_the_sweep_of_a_band():
    """Below a bandwidth: nu over [0, w] alone, which differs from the whole axis; positive there where all is."""
    fewer = 0
    for plant in plants(16):
        poles = np.abs(plant.poles())
        whole = fb.verdict(system_of(plant))
        for width in (0.3 * poles.min(), np.sqrt(poles.min() * poles.max()), 3.0 * poles.max()):
            found = fb.verdict(system_of(plant), bandwidth=width)
            omega = grid(plant.poles())
            omega = np.append(omega[omega < width], width)
            nu, gain = shortage_and_gain(plant.response, omega)
            assert abs(found.shortage - nu) < TOLERANCE * gain
            assert found.positive_real >= whole.positive_real
            assert all(high <= width for _, high in found.fails_at)
            assert found.bandwidth == width
            fewer += found.shortage > whole.shortage + TOLERANCE * gain
    assert fewer > 8


def test_reference_values(paper_pose):
    """theory §5's check cases: the paper's plant, its rounded E, the exact E."""
    found = fb.verdict(paper_pose)
    assert found.shortage == pytest.approx(-0.001383691, abs=5e-10)
    assert found.relative_shortage == pytest.approx(-0.28645, abs=5e-6)
    assert found.worst_at == pytest.approx(277.1029065, rel=1e-6)
    assert not found.positive_real
    assert not found.negative_imaginary
    rounded = fb.verdict(paper_pose, PAPER_E)
    assert rounded.relative_shortage == pytest.approx(-4.1e-5, abs=1e-6)
    assert not rounded.positive_real
    exact = fb.verdict(paper_pose, fb.design(paper_pose, "exact", natural_frequency=346.8))
    assert exact.positive_real
    assert exact.negative_imaginary
    assert exact.relative_shortage == pytest.approx(0.0, abs=1e-12)
    assert exact.fails_at == ()
    assert exact.output_index == pytest.approx(0.0, abs=1e-9)


def test_one_base_joint_has_a_closed_form():
    """nu = w S / (2 Dp) and nu/g = (cos - 1)/2, at any damping, k = 1 to 4.  [theory §4]"""
    for seed in range(12):
        for k in (1, 2, 3, 4):
            pose = random_pose(seed, 1, 4, k, damping=("full", "overdamped", "proportional")[seed % 3])
            with pytest.warns(fb.FlexbaseWarning) if seed % 3 == 1 else nullcontext():
                mode = fb.modes(pose)[0]
            found = fb.verdict(pose)
            nu = min(mode.robustness, 0.0) / (4.0 * mode.damping_ratio * mode.frequency)
            assert found.shortage == pytest.approx(nu, rel=1e-8, abs=1e-12 * found.largest_gain)
            assert found.relative_shortage == pytest.approx((mode.alignment - 1.0) / 2.0, abs=1e-8)


@pytest.mark.parametrize(("m", "n", "k"), [(1, 2, 2), (2, 3, 3), (3, 4, 3), (2, 4, 1), (6, 6, 6)])
@pytest.mark.parametrize("damping", ["zero", "proportional", "full", "overdamped"])
def test_rigid_motion_comes_off_without_an_error(m, n, k, damping):
    """The reduced route, and the full 2N matrices with their double poles at 0 taken off: the same, to 1e-11."""
    pose = random_pose(3, m, n, k, damping=damping)
    reduced, full = fb.verdict(pose), fb.verdict(fb.linearise(pose))
    assert full.rigid_mode == pytest.approx(reduced.rigid_mode, abs=1e-12 * np.abs(reduced.rigid_mode).max())
    assert full.positive_real == reduced.positive_real
    assert full.undamped == pytest.approx(reduced.undamped, rel=1e-10)
    if np.isfinite(reduced.shortage):
        assert full.relative_shortage == pytest.approx(reduced.relative_shortage, abs=1e-11)
        assert np.array(full.fails_at) == pytest.approx(np.array(reduced.fails_at), rel=1e-4)
    assert (len(reduced.undamped) == m) == (damping == "zero")


@pytest.mark.parametrize("seed", range(8))
def test_full_matrices_of_pinocchio_agree(seed):
    """The house's older sweep, of Pinocchio's matrices, with its rigid motion: not positive where we say so."""
    pose = random_pose(seed, 2, 3, 3)
    found = fb.verdict(pose)
    assert found.positive_real == (passivity(pose, np.zeros((3, 3))) > -1e-8)


def test_friction_of_the_arm():
    """With friction on all or some arm joints: a motion against friction alone has no spring, and no pole at 0 in G."""
    for seed in range(6):
        pose = random_pose(seed, 2, 3, 3)
        system = fb.linearise(pose)
        for friction in ([3.0, 1.0, 0.4], [3.0, 0.0, 0.0]):
            rubbed = replace(system, D=system.D + np.diag([0.0, 0.0, *friction]))
            found = fb.verdict(rubbed)
            assert np.linalg.matrix_rank(found.rigid_mode, tol=1e-9) == friction.count(0.0)

            def response(omega, rubbed=rubbed, found=found):
                s = 1j * omega[:, None, None]
                return s * rubbed.transfer_function(1j * omega) - found.rigid_mode / s

            poles = np.linalg.eigvals(rubbed.state_space().A)
            poles = poles[(poles.imag >= 0.0) & (np.abs(poles) > 1e-3)]
            nu, gain = shortage_and_gain(response, grid(poles))
            assert found.shortage == pytest.approx(nu, abs=2e-8 * gain)
            assert found.largest_gain >= gain * (1.0 - 1e-9)  # it may be taken at rest, where the sweep does not go


def test_gravity_that_tips_the_arm_over_is_said():
    """A pose that falls has no passive port; the base by itself is judged beside it."""
    pose = planar([0.4, 0.3, 0.25], gravity=(0.0, -9.81, 0.0)).at([np.pi / 2.0, 0.4])
    found = fb.verdict(pose)
    assert np.linalg.eigvalsh(pose.K)[0] < 0.0
    assert not found.positive_real
    assert not found.negative_imaginary
    assert found.shortage == -np.inf
    assert any("falls" in caveat for caveat in found.caveats)
    still = fb.verdict(planar([0.4, 0.3, 0.25]).at([np.pi / 2.0, 0.4]))
    assert found.base_alone is not None
    assert found.base_alone.shortage == pytest.approx(still.shortage, rel=1e-12)
    assert found.to_dict()["base_alone"]["positive_real"] == still.positive_real
    assert still.base_alone is None


def test_hanging_arm_under_gravity_against_a_sweep():
    """Gravity that holds the arm down stiffens it: lightly damped pendulum modes, no rigid motion."""
    pose = planar([0.4, 0.3, 0.25], gravity=(0.0, -9.81, 0.0), damping=300.0).at([-np.pi / 2.0, 0.1])
    found, system = fb.verdict(pose), FullSystem(pose)
    assert np.linalg.eigvalsh(pose.K)[0] > 0.0
    assert not found.rigid_mode.any()
    poles = system.poles()

    def response(omega):
        return np.array([1j * w * system.response(1j * w) for w in omega])

    nu, gain = shortage_and_gain(response, grid(poles[poles.imag >= 0.0], 80))
    assert found.shortage == pytest.approx(nu, abs=1e-6 * gain)  # the witness inverts nearly singular matrices
    assert found.largest_gain == pytest.approx(gain, rel=1e-6)


def test_undamped_base_is_judged_by_residues():
    """Without damping nu is 0 or -infinity: R = R^T >= 0 of every mode decides, also of two at one frequency."""
    one, two = np.diag([1.0, 1.0]), np.diag([100.0, 100.0])
    U = np.array([[1.0, 0.3], [0.2, 1.0]])
    for V, good in (
        (-U, True),
        (-U @ [[2.0, 0.5], [0.5, 1.0]], True),
        (-U @ [[2.0, 0.5], [-0.5, 1.0]], False),
        (U, False),
    ):
        plant = Plant(one, 0.0 * one, two, U, np.asarray(V))
        found = fb.verdict(system_of(plant))
        assert found.positive_real is good
        assert found.negative_imaginary is good
        assert found.shortage == (0.0 if good else -np.inf)
        assert found.undamped == pytest.approx((10.0,))
        assert found.fails_at == (() if good else ((10.0, 10.0),))
    beyond = fb.verdict(system_of(Plant(one, 0.0 * one, two, U, U)), bandwidth=5.0)
    assert beyond.undamped == pytest.approx((10.0,))
    assert beyond.shortage == 0.0


def test_half_damped_base():
    """One base joint damped, one not: the undamped mode by its residue, the rest by its response."""
    S, K, D = np.eye(2), np.diag([100.0, 400.0]), np.diag([0.0, 3.0])
    U = np.array([[1.0, 0.4], [0.3, 1.0]])
    good = fb.verdict(system_of(Plant(S, D, K, U, -U)))
    assert good.positive_real
    V = -U.copy()
    V[:, 1] = [0.5, -1.0]
    rest = Plant(S[1:, 1:], D[1:, 1:], K[1:, 1:], U[:, 1:], V[:, 1:])
    nu, gain = shortage_and_gain(rest.response, grid(rest.poles()))
    found = fb.verdict(system_of(Plant(S, D, K, U, V)))
    assert found.shortage == pytest.approx(nu, abs=TOLERANCE * gain)
    assert not found.positive_real


def test_negative_imaginary_is_its_own_sweep():
    """lambda_min of i (P - P*)/2 over max |P|, at all positive frequencies, to 1e-8."""
    for plant in plants(30):
        found = fb.verdict(system_of(plant))

        def displaced(omega, plant=plant):
            return plant.response(omega) / omega[:, None, None]

        omega = np.append(grid(plant.poles()), 1e-9)
        least = min(0.0, lowest(lambda w, f=displaced: least_eigenvalue(f, w), np.sort(omega)))
        gain = -lowest(lambda w, f=displaced: -np.linalg.svd(f(w), compute_uv=False)[:, 0], np.sort(omega))
        assert found.negative_imaginary_shortage == pytest.approx(least / gain, abs=TOLERANCE)
        assert found.negative_imaginary == found.positive_real  # the same property, to the tolerance of G
        assert found.negative_imaginary >= (least >= -TOLERANCE * gain)


def test_base_turning_about_the_first_arm_joint_does_no_harm():
    """U = 0 but for rounding: rounding must not be judged."""
    plant, rng = planar([0.0, 0.3, 0.25]), np.random.default_rng(0)
    for _ in range(20):
        found = fb.verdict(plant.at(rng.uniform(0.2, 2.9, 2)))
        assert found.positive_real
        assert (found.shortage, found.largest_gain) == (0.0, 0.0)


def test_rigid_base_and_one_row():
    with pytest.warns(fb.FlexbaseWarning, match="rigid base"):
        rigid = fb.verdict(planar([0.3, 0.25], m=0).at([0.4, 0.9]))
    assert rigid.positive_real
    assert rigid.output_index == 0.0
    cart = fb.verdict(sliding_pair(0.7).at([0.1]))
    assert cart.relative_shortage == pytest.approx(-1.0, abs=1e-12)  # k = 1: the signs of a and b differ


@pytest.mark.parametrize("robot", ["ur5e-gantry", "ur5e-platform", "scara"])
def test_bundled_robots(robot):
    """A pose of each against the sweep of its full matrices."""
    plant = fb.load(robot)
    pose = plant.at(0.3 + 0.4 * np.arange(plant.arm.n) / plant.arm.n)
    found, system = fb.verdict(pose), fb.linearise(pose)

    def response(omega):
        s = 1j * omega[:, None, None]
        return s * system.transfer_function(1j * omega) - found.rigid_mode / s

    poles = FullSystem(pose).vibrations()
    nu, gain = shortage_and_gain(response, grid(poles))
    assert found.shortage == pytest.approx(nu, abs=1e-7 * gain)  # the full matrices lose digits beside R0/s
    assert found.largest_gain == pytest.approx(gain, rel=1e-7)


def test_the_map_has_the_same_number(paper, paper_pose):
    """The measure passivity_shortage, compiled and in rows, is the exact verdict's number, to 1e-10 of it."""
    chart = fb.sweep(paper, ["passivity_shortage", "shortage"], fb.Cells(shape=(7, 7)))
    good = np.argwhere(chart.status.values == 0)
    assert len(good) > 10
    for i, j in good[::3]:
        found = fb.verdict(paper.at_tip([float(chart.x[j]), float(chart.y[i])]))
        scale = found.largest_gain
        assert chart.passivity_shortage.values[i, j] == pytest.approx(found.shortage, rel=1e-9, abs=1e-12 * scale)
        assert chart.shortage.values[i, j] == pytest.approx(-found.relative_shortage, abs=1e-9)


def test_result_in_words_and_numbers(paper_pose):
    found = fb.verdict(paper_pose)
    assert "Not positive real" in found.summary()
    assert "at all frequencies" in found.summary()
    plain = json.loads(json.dumps(found.to_dict()))
    assert plain["shortage"] == found.shortage
    assert plain["fails_at_rad_s"] == [list(interval) for interval in found.fails_at]
    assert found.least_eigenvalue(np.array([found.worst_at]))[0] == pytest.approx(found.shortage, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"M": np.diag([1.0, -1.0])}, "no inertia"),
        ({"D": np.diag([1.0, -1.0])}, "feeds energy"),
        ({"K": np.array([[1.0, 2.0], [0.0, 1.0]])}, "not symmetric"),
        ({"B": np.ones((2, 1))}, "velocity for each force"),
    ],
)
def test_systems_of_another_kind_are_refused(change, said):
    eye = np.eye(2)
    system = fb.SecondOrder(eye, eye, eye, eye, eye, ("a", "b"), ("f", "g"), ("y", "z"))
    with pytest.raises(fb.InputError, match=said):
        fb.verdict(replace(system, **change))


def test_other_input_is_refused(paper_pose):
    with pytest.raises(fb.InputError, match="bandwidth"):
        fb.verdict(paper_pose, bandwidth=-1.0)
    with pytest.raises(fb.InputError, match="pose"):
        fb.verdict("ueda2003")
    with pytest.raises(fb.InputError, match="Take E from its M"):
        fb.verdict(fb.linearise(paper_pose), PAPER_E)
    with pytest.raises(fb.InputError, match="not positive definite"):
        fb.verdict(paper_pose, Gain(np.diag([9.0, 9.0])))
