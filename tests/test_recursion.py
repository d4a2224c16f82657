"""The paper's recursion: its slopes, its seed, its convergence, and task priority for several modes.  [U03 eq 12-16]"""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import flexbase
from flexbase import FlexbaseWarning, Infeasible, InputError
from flexbase.compensators.search.mode_parameters import mode_parameters, parameter_slopes, symmetric, upper_triangle
from systems.oracle import FullSystem
from systems.planar import planar
from systems.random_plants import random_pose

SHAPES = [(1, 2, 2), (1, 3, 2), (2, 2, 2), (2, 3, 3), (3, 3, 2), (3, 4, 3)]


def solve(pose, method, **options):
    """The design; it warns where rho or mu is 1 or more."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlexbaseWarning)
        return flexbase.design(pose, method, **options)


def witness(pose, E):
    """[w_i, omega_i] from the full system alone: Cauchy's integral and eigenvalues."""
    system, values = FullSystem(pose, E), []
    for pole in system.vibrations():
        R = system.mode_residue(pole)
        values.append([np.linalg.eigvalsh(R + R.T)[0], abs(pole)])
    return np.array(values)


@pytest.mark.parametrize("damping", ["zero", "proportional", "full"])
@pytest.mark.parametrize(("m", "n", "k"), SHAPES)
def test_mode_parameters_are_those_of_the_full_system(m, n, k, damping):
    """phi_i = [w_i, omega_i] away from E = 0, against Cauchy's integral, to 1e-8 of each column."""
    pose = random_pose(21, m, n, k, damping=damping)
    E = 0.2 * np.linalg.eigvalsh(pose.M)[0] * np.cos(np.add.outer(np.arange(n), np.arange(n)))
    ours, theirs = mode_parameters(pose, E).values, witness(pose, E)
    for column in range(2):
        size = np.abs(theirs[:, column]).max()
        assert ours[:, column] == pytest.approx(theirs[:, column], rel=0.0, abs=1e-8 * size)


@pytest.mark.parametrize("damping", ["zero", "proportional", "full"])
@pytest.mark.parametrize(("m", "n", "k"), SHAPES)
def test_exact_slopes_are_central_differences(m, n, k, damping):
    """H = d[w, omega]/d rho, including non-proportional damping, against fourth-order central differences.

    Step 1e-3 of the inertia: truncation 1e-12 relative, rounding 1e-12; 1e-6 of each row leaves room for curvature.
    """
    for seed in range(3):
        pose = random_pose(seed, m, n, k, damping=damping)
        E = 0.1 * np.linalg.eigvalsh(pose.M)[0] * np.cos(np.add.outer(np.arange(n), np.arange(n)))
        slopes = parameter_slopes(pose, E, mode_parameters(pose, E))
        size = 1e-4 * np.linalg.eigvalsh(pose.M)[0]
        rho = upper_triangle(E)
        for j in range(len(rho)):
            step = size * np.eye(len(rho))[j]

            def at(times, rho=rho, step=step, pose=pose):
                return mode_parameters(pose, symmetric(rho + times * step, n)).values

            difference = (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12.0 * size)
            scale = np.abs(slopes).max(axis=2)
            assert np.all(np.abs(slopes[:, :, j] - difference) <= 1e-6 * scale + 1e-12)


def test_history_starts_without_a_gain_and_ends_with_the_design(paper_pose):
    """801 records of w_1, omega_1, lambda_min(M - E): the first is E = 0, the last the certificate's."""
    found = solve(paper_pose, "recursive", natural_frequency=346.8)
    certificate, history = found.certificate, found.history
    assert {len(curve) for curve in history.values()} == {801}
    assert history["robustness"][0] == pytest.approx(certificate.robustness_before[0], rel=1e-9)
    assert history["frequency_rad_s"][0] == pytest.approx(certificate.frequency_before_rad_s[0], rel=1e-12)
    assert history["frequency_rad_s"][-1] == pytest.approx(certificate.frequency_after_rad_s[0], rel=1e-12)
    assert history["min_eig_modified_inertia"][-1] == pytest.approx(certificate.min_eig_modified_inertia, rel=1e-9)


def test_error_shrinks_by_one_minus_the_step(paper_pose):
    """rho <- rho + g H^+ (phi_d - phi): the frequency's error falls by (1 - g) an iteration, to second order in g.

    After 800 steps of 0.02 that is 1e-7; each ratio is 0.98 to 1e-2 once the start's curvature is left behind.
    """
    history = solve(paper_pose, "recursive", natural_frequency=346.8, derivatives="exact").history
    gap = np.abs(history["frequency_rad_s"] - 346.8)
    ratios = gap[101:700] / gap[100:699]
    assert ratios == pytest.approx(np.full(len(ratios), 0.98), abs=1e-2)
    assert gap[-1] / gap[0] == pytest.approx(0.98**800, rel=1.0)


def test_estimated_slopes_follow_the_seed(paper_pose):
    """The same seed gives the same bits; another seed another path to the same targets."""
    options = {"natural_frequency": 346.8, "iterations": 120}
    one, again, other = (solve(paper_pose, "recursive", seed=seed, **options) for seed in (4, 4, 5))
    assert np.array_equal(one.E, again.E)
    assert all(np.array_equal(one.history[key], again.history[key]) for key in one.history)
    assert not np.array_equal(one.E, other.E)


def test_estimated_slopes_end_where_exact_ones_do(paper_pose):
    """Small trial variations measure H well: E agrees with the exact recursion's to 1e-4 of its size.

    The trials are 1e-5 of the inertia, so each estimated slope is wrong by its curvature times that.
    """
    exact = solve(paper_pose, "recursive", natural_frequency=346.8, derivatives="exact")
    estimated = solve(paper_pose, "recursive", natural_frequency=346.8, derivatives="estimated")
    assert pytest.approx(exact.E, rel=0.0, abs=1e-4 * np.abs(exact.E).max()) == estimated.E
    assert not np.array_equal(estimated.E, exact.E)


def planar_pose(number):
    """The number-th of a list of random poses of a planar arm on two base joints."""
    joints = np.random.default_rng(0).uniform(-2.5, 2.5, (5, 2))[number]
    return planar([0.3, 0.25, 0.35, 0.3], m=2, damping=3.0).at(joints)


WHICH = {
    "space": lambda: random_pose(1, 2, 3, 2),
    "planar 0": lambda: planar_pose(0),
    "planar 2": lambda: planar_pose(2),
}


@pytest.mark.parametrize("derivatives", ["exact", "estimated"])
@pytest.mark.parametrize("which", WHICH)
def test_task_priority_meets_the_first_modes_targets(which, derivatives):
    """m = 2: w_1 = 0 and omega_1 on target, by the full system's own modes; 0.98^800 leaves 1e-7 of the way.

    Where E has entries enough ("space"), the second mode's targets are met as well. At E = 0 (the control) w_1 is far
    from 0. Estimated slopes leak: the second mode's endless steps lie in a null space known to the trial size only, so
    there 1e-3 must do.
    """
    tolerance = 1e-5 if derivatives == "exact" else 1e-3
    pose = WHICH[which]()
    before = witness(pose, np.zeros((pose.arm.n, pose.arm.n)))
    targets = 1.1 * before[:, 1]
    found = solve(pose, "task-priority", natural_frequency=targets.tolist(), derivatives=derivatives)
    after = witness(pose, found.E)
    assert before[0, 0] < -1e-3
    assert abs(after[0, 0]) < tolerance * abs(before[0, 0])
    assert after[0, 1] == pytest.approx(targets[0], rel=tolerance)
    if which == "space":
        assert abs(after[1, 0]) < tolerance * abs(before[1, 0])
        assert after[1, 1] == pytest.approx(targets[1], rel=tolerance)
        assert found.certificate.target_residual < tolerance
    else:
        assert found.certificate.target_residual > 1e-4  # and the certificate says what stayed unmet


def test_later_modes_never_cost_the_first_its_targets():
    """The step for mode 2 lies in the null space of mode 1's slopes: mode 1 moves as if it were alone."""
    from flexbase.compensators.search.recursion import _priority_step

    pose = random_pose(2, 2, 3, 3)
    E = np.zeros((3, 3))
    now = mode_parameters(pose, E)
    H = parameter_slopes(pose, E, now)
    wanted = 0.02 * np.array([[0.0, 1.0], [0.0, 1.2]]) * now.values[:, 1:] - 0.02 * now.values
    step = _priority_step(H, wanted)
    assert H[0] @ step == pytest.approx(wanted[0], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(("frequency", "step"), [(5000.0, 0.5), (50.0, 0.5)])
def test_a_target_out_of_reach_is_infeasible(paper_pose, frequency, step):
    """Where M - E > 0 is lost, or the end lies far from the targets: Infeasible, with the iteration and the mend.

    The control is the exact design, which proves that 50 rad/s lies below every aligned solution.
    """
    with pytest.raises(Infeasible, match=r"after \d+ of 800 iterations.*Ask for other"):
        solve(paper_pose, "recursive", natural_frequency=frequency, step=step)
    if frequency < 300.0:
        with pytest.raises(Infeasible, match="out of reach"):
            solve(paper_pose, "exact", natural_frequency=frequency)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"step": 0.0}, "step: 0 must be above 0"),
        ({"step": 1.5}, "step: 1.5 must be above 0 and at most 1"),
        ({"iterations": 0}, "iterations: 0 must be 1 or more"),
        ({"derivatives": "guessed"}, '"guessed" is unknown'),
        ({"natural_frequency": float("nan")}, "natural frequency"),
        ({"natural_frequency": -5.0}, "natural frequency"),
        ({"iteration": 3}, 'Did you mean "iterations"'),
    ],
)
def test_wrong_options_are_refused(paper_pose, options, message):
    """Each wrong option: one InputError that names it."""
    with pytest.raises(InputError, match=message):
        solve(paper_pose, "recursive", **options)
