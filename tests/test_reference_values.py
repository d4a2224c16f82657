"""The paper's system at (0.33, -0.25): theory §9's values, digit by digit, and §8's margins."""

from __future__ import annotations

import numpy as np
import pytest

import flexbase
from flexbase import FlexbaseWarning
from flexbase.compensators.methods.exact import compensability
from flexbase.linear.margins import (
    algebraic_loop_radius,
    algebraic_loop_radius_per_joint,
    closed_loop_abscissa,
    lag_margin,
)

TARGET = 346.8
PAPER_E = np.array([[0.12, 0.079], [0.079, -0.15]])  # as printed, [U03 eq 17]
RECURSION_E = np.array([[0.142473, 0.047450], [0.047450, -0.103979]])
LEAST_NORM_E = np.array([[0.164677, 0.016120], [0.016120, -0.059773]])


def half_of_last(value: str) -> float:
    """Half a unit of the last printed digit: all that a printed value can promise."""
    return 0.5001 * 10.0 ** -len(value.partition(".")[2])


def agrees(ours: float, printed: str) -> bool:
    return abs(ours - float(printed)) <= half_of_last(printed)


@pytest.fixture(scope="module")
def exact(paper_pose):
    return flexbase.design(paper_pose, "exact", natural_frequency=TARGET)


@pytest.fixture(scope="module")
def recursive(paper_pose):
    with pytest.warns(FlexbaseWarning, match=r"radius 1\.236"):
        return flexbase.design(paper_pose, "recursive", natural_frequency=TARGET, derivatives="exact")


def test_joint_angles(paper_pose):
    """q2, q3 in degrees, to the printed eight digits."""
    assert paper_pose.q[0] == 0.0
    assert agrees(np.degrees(paper_pose.q[1]), "-113.30630279")
    assert agrees(np.degrees(paper_pose.q[2]), "119.16545949")


def test_arm_inertia(paper_pose):
    """Mhat, exact decimals of Table I: to 1e-12."""
    assert paper_pose.M[1:, 1:] == pytest.approx(np.array([[0.581375, 0.01275], [0.01275, 0.104125]]), abs=1e-12)


def test_residue_frequency_and_w(paper_pose):
    """R_1, omega_1 and w_1, to the last digit that the table gives."""
    mode = flexbase.modes(paper_pose)[0]
    printed = [["-0.03250938", "-0.07462994"], ["0.03716396", "0.08531520"]]
    for i in range(2):
        for j in range(2):
            assert agrees(mode.residue[i, j], printed[i][j])
    assert agrees(mode.robustness, "-0.0708320860")
    assert agrees(mode.frequency, "277.1029065")


def test_loop_without_compensator_is_unstable(paper, paper_pose):
    """Rightmost pole +3.66851755 at the paper's gains, to its last digit; it is the library's and the certificate's."""
    abscissa = closed_loop_abscissa(paper_pose, np.zeros((2, 2)), paper.arm.gains)
    assert agrees(abscissa, "3.66851755")


def test_recursion_with_exact_slopes(recursive):
    """After 800 iterations from E = 0: E to its six printed digits, w = -7e-9, omega = 346.79999."""
    assert pytest.approx(RECURSION_E, rel=0.0, abs=0.51e-6) == recursive.E
    after = recursive.certificate
    assert after.robustness_after[0] == pytest.approx(-7e-9, abs=0.5e-9)
    assert agrees(after.frequency_after_rad_s[0], "346.79999")
    assert len(recursive.history["robustness"]) == 801


def test_exact_design_of_least_norm(paper_pose, exact):
    """E to its six printed digits, lambda_min(M - E) = 0.062976, |w| < 1e-12, omega to 1e-9 of the target."""
    assert pytest.approx(LEAST_NORM_E, rel=0.0, abs=0.51e-6) == exact.E
    assert agrees(exact.certificate.min_eig_modified_inertia, "0.062976")
    assert abs(exact.certificate.robustness_after[0]) < 1e-12
    assert exact.certificate.frequency_after_rad_s[0] == pytest.approx(TARGET, rel=1e-9)


def test_residue_after_design_does_not_depend_on_the_solution(paper_pose, exact, recursive):
    """R_1 after design is alpha (1 + alpha)/S Jp Jp^T, the same for every E of the family.  [theory §7]

    The exact one to the printed digits; the recursion's to what 800 steps leave, 1e-4.
    """
    printed = [["0.036302", "0.047918"], ["0.047918", "0.063252"]]
    R = flexbase.modes(paper_pose, exact)[0].residue
    for i in range(2):
        for j in range(2):
            assert agrees(R[i, j], printed[i][j])
    assert flexbase.modes(paper_pose, recursive)[0].residue == pytest.approx(R, abs=1e-4)


def test_the_papers_rounded_gain_is_near_the_family(paper_pose):
    """The printed E: w = -8e-6, omega = 345.9."""

    class Printed:
        E = PAPER_E

    mode = flexbase.modes(paper_pose, Printed())[0]
    assert agrees(1e6 * mode.robustness, "-8")
    assert agrees(mode.frequency, "345.9")


@pytest.mark.parametrize(
    ("E", "rho", "mu", "lag_ms"),
    [
        (PAPER_E, "1.775", "1.905", "1.51"),
        (RECURSION_E, "1.236", "1.384", "1.42"),
        (LEAST_NORM_E, "0.723", "0.932", "1.30"),
    ],
    ids=["paper", "recursion", "least norm"],
)
def test_margins_of_the_three_gains(paper, paper_pose, E, rho, mu, lag_ms):
    """Algebraic-loop radii and first-order lag margins of theory §8, to their printed digits."""
    assert agrees(algebraic_loop_radius(paper_pose, E), rho)
    assert agrees(algebraic_loop_radius_per_joint(paper_pose, E), mu)
    assert agrees(1e3 * lag_margin(paper_pose, E, paper.arm.gains), lag_ms)


def test_slowest_reachable_frequency(paper_pose):
    """300.3 rad/s at the paper's point, above the mode's 277.1: compensable is not reachable.  [theory §7]"""
    assert agrees(compensability(paper_pose).slowest, "300.3")


def test_table_one(paper):
    """The bundled file holds Table I as theory §9 unscrambles it."""
    mechanism, base = paper.arm.mechanism, paper.arm.base
    assert mechanism.mass.tolist() == [20.0, 7.0, 5.0]
    assert mechanism.inertia[:, 2, 2].tolist() == [0.066, 0.0525, 0.026]
    assert [*mechanism.placement_position[1:, 0], mechanism.tool_position[0]] == [0.2, 0.3, 0.25]
    assert mechanism.com[:, 0].tolist() == [0.02, 0.15, 0.125]
    assert base.stiffness.tolist() == [[3e4]]
    assert base.damping.tolist() == [[10.0]]
    assert np.array_equal(paper.arm.gains.stiffness, np.diag([1e5, 1e5]))
    assert np.array_equal(paper.arm.gains.damping, np.diag([1.5e3, 1.5e3]))
