"""Modal analysis: the sum over modes is the transfer function, and w says what it should.  [theory §3, §4]"""

from __future__ import annotations

import dataclasses
import warnings
from decimal import Decimal, getcontext

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import flexbase
from flexbase import FlexbaseWarning
from flexbase.linear.reduced import alignment, robustness
from flexbase.model.loop import Gain
from systems.oracle import FullSystem
from systems.planar import planar, sliding_pair
from systems.random_plants import DAMPINGS, random_pose

SHAPES = [(1, 2, 1), (1, 2, 2), (1, 3, 3), (2, 2, 2), (2, 3, 2), (2, 4, 3), (3, 3, 1), (3, 4, 3), (1, 4, 2)]


def modes_of(pose, compensator=None):
    """Modes; an overdamped base may warn, as its own test checks."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlexbaseWarning)
        return flexbase.modes(pose, compensator)


def small_gain(pose):
    """Some symmetric gain that keeps M - E positive definite."""
    rng = np.random.default_rng(2)
    E = rng.normal(size=(pose.arm.n, pose.arm.n))
    E = E + E.T
    return Gain(0.5 * np.linalg.eigvalsh(pose.M)[0] * E / np.abs(np.linalg.eigvalsh(E)).max())


@pytest.mark.parametrize("compensated", [False, True])
@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.parametrize(("m", "n", "k"), SHAPES)
def test_sum_over_modes_is_the_transfer_function(m, n, k, damping, compensated):
    """R0/s^2 + sum (R' s + R)/(s^2 + 2 zeta omega s + omega^2) = P(s) at random complex s.  [theory §3]

    Undamped, proportional, non-proportional and overdamped bases; redundant arms; with and without a gain. The witness
    P is assembled from Pinocchio's matrices. 1e-9 of P: real poles of an overdamped base lie up to 1e4 apart.
    """
    rng = np.random.default_rng(m + 10 * n)
    for seed in range(4):
        pose = random_pose(seed, m, n, k, damping=damping)
        compensator = small_gain(pose) if compensated else None
        found = modes_of(pose, compensator)
        system = FullSystem(pose, None if compensator is None else compensator.E)
        assert len(found) >= m
        for s in rng.uniform(-300.0, 300.0, 6) + 1j * rng.uniform(50.0, 3000.0, 6):
            total = found.rigid_mode / s**2 + sum(
                (mode.residue_s * s + mode.residue)
                / (s**2 + 2.0 * mode.damping_ratio * mode.frequency * s + mode.frequency**2)
                for mode in found.modes
            )
            P = system.response(s)
            assert total == pytest.approx(P, rel=0.0, abs=1e-9 * np.abs(P).max())


@pytest.mark.parametrize("damping", ["zero", "proportional", "full"])
@pytest.mark.parametrize(("m", "n", "k"), SHAPES)
def test_frequencies_are_poles_of_the_full_system(m, n, k, damping):
    """omega = |l| and zeta = -Re l/|l| of the 2N system's vibration poles, slowest first, to 1e-9."""
    pose = random_pose(11, m, n, k, damping=damping)
    poles = FullSystem(pose).vibrations()
    found = modes_of(pose).modes
    assert [mode.frequency for mode in found] == pytest.approx(np.abs(poles), rel=1e-9)
    assert [mode.damping_ratio for mode in found] == pytest.approx(-poles.real / np.abs(poles), abs=1e-9)


@pytest.mark.parametrize("damping", ["zero", "proportional", "full"])
@pytest.mark.parametrize(("m", "n", "k"), [(1, 2, 2), (2, 3, 2), (2, 4, 3), (3, 3, 1)])
def test_residues_and_w_by_cauchys_integral(m, n, k, damping):
    """R_i is the integral of P around its pole, and w_i the smallest eigenvalue of R_i + R_i^T.  [U03 eq 7, 9]"""
    pose = random_pose(12, m, n, k, damping=damping)
    system = FullSystem(pose)
    for mode, pole in zip(modes_of(pose).modes, system.vibrations(), strict=True):
        R = system.mode_residue(pole)
        size = np.abs(R).max()
        assert mode.residue == pytest.approx(R, rel=0.0, abs=1e-9 * size)
        assert mode.robustness == pytest.approx(np.linalg.eigvalsh(R + R.T)[0], rel=0.0, abs=1e-9 * size)


@pytest.mark.parametrize("damping", ["zero", "full"])
def test_shapes_solve_the_eigenvalue_problem(damping):
    """(M l^2 + D l + K) shape = 0 with the full matrices, the largest entry is 1, and the shares add up to 1."""
    pose = random_pose(13, 2, 3, 2, damping=damping)
    system = FullSystem(pose)
    for mode, pole in zip(modes_of(pose).modes, system.vibrations(), strict=True):
        left = (system.M * pole**2 + system.D * pole + system.K) @ mode.shape
        assert np.abs(left).max() < 1e-9 * np.abs(system.K).max()
        assert np.abs(mode.shape).max() == pytest.approx(1.0, rel=1e-14)
        assert mode.participation.sum() == pytest.approx(1.0, rel=1e-12)


def test_sliding_pair_has_its_closed_form():
    """Cart, oblique slider: S = m1 + m2 sin^2, V = c^2, U = s^2, omega^2 = K/S, R = -s^2 c^2/S, R0 = c^2/m2."""
    angle, m1, m2, K, D = 0.7, 12.0, 3.0, 5e4, 20.0
    c2, s2 = np.cos(angle) ** 2, np.sin(angle) ** 2
    S = m1 + m2 * s2
    found = flexbase.modes(sliding_pair(angle, m1, m2, K, D).at([0.1]))
    assert found[0].frequency == pytest.approx(np.sqrt(K / S), rel=1e-13)
    assert found[0].damping_ratio == pytest.approx(D / (2.0 * np.sqrt(K * S)), rel=1e-13)
    assert found[0].residue == pytest.approx(np.array([[-s2 * c2 / S]]), rel=1e-13)
    assert found[0].robustness == pytest.approx(-2.0 * s2 * c2 / S, rel=1e-13)
    assert found.rigid_mode == pytest.approx(np.array([[c2 / m2]]), rel=1e-13)
    assert not found.positive_real


def test_overdamped_base_warns_and_keeps_its_poles():
    """A base beyond critical damping is accepted with a warning; zeta and omega still give its two real poles."""
    pose = sliding_pair(0.7, damping=1e4).at([0.1])
    with pytest.warns(FlexbaseWarning, match="overdamped base, real poles"):
        mode = flexbase.modes(pose)[0]
    real = -mode.frequency * (mode.damping_ratio + np.array([1.0, -1.0]) * np.sqrt(mode.damping_ratio**2 - 1.0))
    poles = FullSystem(pose).poles()
    for pole in real:
        assert np.abs(poles - pole).min() < 1e-9 * abs(pole)


def test_rigid_base_has_no_modes():
    """m = 0: no vibration mode, P = R0/s^2 with R0 = Jv Mhat^-1 Jv^T, positive real."""
    with pytest.warns(FlexbaseWarning, match=r"no \[base\] joints"):
        plant = planar([0.3, 0.25], m=0)
    pose = plant.at([0.4, 0.9])
    found, system = flexbase.modes(pose), FullSystem(pose)
    assert len(found) == 0
    assert found.positive_real
    assert found.rigid_mode == pytest.approx(system.C @ np.linalg.solve(system.M, system.B), rel=1e-12)


def test_base_turning_about_the_first_arm_joint_has_no_say_in_the_tip():
    """A base yaw coaxial with joint 1: U = 0, so R = 0, w = 0, the alignment is undefined, not NaN.  [theory §4]

    At every pose: rounding of U, some 1e-17, must not decide the verdict.
    """
    plant, rng = planar([0.0, 0.3, 0.25]), np.random.default_rng(0)
    for _ in range(50):
        found = flexbase.modes(plant.at(rng.uniform(0.2, 2.9, 2)))
        assert found[0].residue == pytest.approx(np.zeros((2, 2)), abs=1e-12)
        assert found[0].robustness == pytest.approx(0.0, abs=1e-12)
        assert found[0].alignment is None
        assert found.positive_real


VECTORS = (
    st.integers(2, 4)
    .flatmap(lambda k: st.tuples(*[st.lists(st.floats(-50.0, 50.0, width=32), min_size=k, max_size=k)] * 2))
    .filter(lambda pair: min(np.linalg.norm(pair[0]), np.linalg.norm(pair[1])) > 1e-3)
)


@given(VECTORS)
def test_w_of_a_dyad_is_its_smallest_eigenvalue(pair):
    """w = a.b - |a||b| = lambda_min(a b^T + b a^T), never positive, and the cosine is a.b/|a||b|.  [theory §4]

    1e-13 of |a||b|: what an eigenvalue routine can promise.
    """
    a, b = map(np.array, pair)
    size = np.linalg.norm(a) * np.linalg.norm(b)
    dyad = np.outer(a, b)
    w = robustness(tuple(pair[0]), tuple(pair[1]))
    assert w <= 0.0
    assert w == pytest.approx(np.linalg.eigvalsh(dyad + dyad.T)[0], rel=0.0, abs=1e-13 * size)
    assert alignment(tuple(pair[0]), tuple(pair[1])) == pytest.approx(a @ b / size, rel=0.0, abs=1e-14)


@pytest.mark.parametrize("misalignment", [1e-3, 1e-6, 1e-9, 1e-12])
def test_w_keeps_its_digits_where_a_and_b_align(misalignment):
    """Near alignment w is of second order; fifty-digit arithmetic is the witness.

    Rounding of the unit vectors, 2e-16, over the misalignment is the relative error that remains in the gap.
    The eigenvalue and the difference form lose all digits below 1e-8: the control.
    """
    a, b = (0.6, -0.3, 0.2), (0.6 * 1.7, -0.3 * 1.7, 0.2 * 1.7 + misalignment)
    getcontext().prec = 50
    exact_a, exact_b = [Decimal(x) for x in a], [Decimal(x) for x in b]
    product = sum(x * y for x, y in zip(exact_a, exact_b, strict=True))
    lengths = (sum(x * x for x in exact_a) * sum(x * x for x in exact_b)).sqrt()
    wanted = float(product - lengths)
    assert robustness(a, b) == pytest.approx(wanted, rel=1e-15 / misalignment + 1e-12)
    if misalignment <= 1e-9:
        dyad = np.outer(a, b)
        assert abs(np.linalg.eigvalsh(dyad + dyad.T)[0] / wanted - 1.0) > 0.5


def test_w_of_one_task_row_can_be_positive():
    """k = 1: w = 2 a b, of either sign.  [theory §4]"""
    assert robustness((2.0,), (3.0,)) == 12.0
    assert robustness((2.0,), (-3.0,)) == -12.0


def test_verdict_agrees_with_the_phase_of_the_response():
    """One base joint: positive residues exactly where G(i w) + G(i w)^* >= 0 at all frequencies.  [theory §4]

    Random plants with one task row give both verdicts; the witness scans the frequency axis.
    """
    verdicts = []
    for seed in range(20):
        pose = random_pose(seed, 1, 2, 1, damping="full")
        found, system = flexbase.modes(pose), FullSystem(pose)
        grid = found[0].frequency * np.geomspace(0.1, 10.0, 400)
        lowest = min((1j * w * system.response(1j * w)).real.item() for w in grid)
        assert found.positive_real == (lowest > -1e-12)
        verdicts.append(found.positive_real)
    assert len(set(verdicts)) == 2


@pytest.mark.parametrize("verb", [flexbase.modes, flexbase.verdict, flexbase.manipulability])
def test_cautions_are_kept_with_the_answer(paper_pose, verb):
    """A compensator of another robot is used, and said to be, once; the answer keeps it and its summary says it."""
    borrowed = dataclasses.replace(flexbase.design(paper_pose, natural_frequency=346.8), robot="another")
    with pytest.warns(FlexbaseWarning, match='designed for "another"') as said:
        found = verb(paper_pose, borrowed)
    assert len(said) == 1
    assert found.cautions == ('compensator: designed for "another", used on "ueda2003".',)
    assert f"caution: {found.cautions[0]}" in found.summary()


def test_unknown_convention_is_refused(paper_pose):
    with pytest.raises(flexbase.InputError, match=r'convention: "torqe" is unknown\. Did you mean "torque"'):
        flexbase.manipulability(paper_pose, convention="torqe")
