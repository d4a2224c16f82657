"""The exact design: both targets met, its objectives truly smallest, its refusals true.  [theory §7]"""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest
from scipy.optimize import differential_evolution, minimize

import flexbase
from flexbase import FlexbaseWarning, Infeasible, InputError
from flexbase.compensators.methods.exact import compensability
from flexbase.compensators.search.mode_parameters import symmetric, upper_triangle
from flexbase.linear.aligned_gain import SMALLEST_INERTIA
from systems.oracle import FullSystem
from systems.planar import planar, sliding_pair
from systems.random_plants import random_pose

OBJECTIVES = ("least-gain", "least-radius")
SIZES = [1, 2, 3, 4]


def solve(pose, **options):
    """The design; it warns where rho or mu is 1 or more, which its own tests check."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlexbaseWarning)
        return flexbase.design(pose, "exact", **options)


def compensable_poses(n, count, *, damping="full"):
    """Random poses with m = 1, k = n where the compensability test says yes."""
    found = []
    for seed in range(200):
        pose = random_pose(seed, 1, n, n, damping=damping)
        if np.isfinite(compensability(pose).slowest):
            found.append(pose)
        if len(found) == count:
            return found
    raise AssertionError("too few compensable poses")


def facts(pose):
    """z, y and the family's free directions, from Pinocchio's matrices."""
    system = FullSystem(pose)
    z = np.linalg.solve(system.C[:, 1:], system.C[:, 0])
    return system, z, -system.M[1:, 0], np.linalg.svd(z[None, :])[2][1:].T


def wanted_frequency(pose, factor=1.3):
    return factor * max(flexbase.modes(pose)[0].frequency, compensability(pose).slowest)


@pytest.mark.parametrize("objective", OBJECTIVES)
@pytest.mark.parametrize("n", SIZES)
def test_both_targets_hold_exactly(n, objective):
    """w = 0 to 1e-12 of |a||b|, omega to 1e-9, M - E > 0, at random damped plants; the witness is the full system.

    The residue by Cauchy's integral is symmetric and positive semidefinite to that integral's 1e-8.
    """
    solved = 0
    for pose in compensable_poses(n, 12):
        target = wanted_frequency(pose)
        try:
            E = solve(pose, natural_frequency=target, objective=objective).E
        except Infeasible as refusal:
            assert objective == "least-radius"  # may ask for more than M - E > 0 leaves, and says so
            assert "no longer positive" in str(refusal)  # noqa: PT017
            continue
        solved += 1
        assert np.array_equal(E, E.T)
        system = FullSystem(pose, E)
        assert np.linalg.eigvalsh(system.M)[0] > 0.0
        pole = system.vibrations()[0]
        assert abs(pole) == pytest.approx(target, rel=1e-9)
        R = system.mode_residue(pole)
        size = np.abs(R).max()
        assert pytest.approx(R.T, rel=0.0, abs=1e-8 * size) == R
        assert np.linalg.eigvalsh(R + R.T)[0] > -1e-8 * size
        mode = flexbase.modes(pose, flexbase.model.loop.Gain(E))[0]
        assert abs(mode.robustness) < 1e-12 * size or (n == 1 and mode.robustness > 0.0)
        assert mode.alignment == pytest.approx(1.0, abs=1e-12)
    assert solved >= 6


def test_without_the_gain_the_same_checks_fail():
    """The control: at E = 0 none of these plants is aligned or at its target frequency."""
    for pose in compensable_poses(2, 12):
        mode = flexbase.modes(pose)[0]
        assert mode.alignment < 1.0 - 1e-6
        assert abs(mode.frequency / wanted_frequency(pose) - 1.0) > 0.1


@pytest.mark.parametrize("n", [2, 3, 4])
def test_least_gain_is_smallest_in_its_family(n):
    """No member of the family E + Z T Z^T with T-block of X above the floor has a smaller Frobenius norm.

    Perturbations small and large, random; the objective is convex, so a descent direction would show in the small ones.
    """
    tried = 0
    for pose in compensable_poses(n, 8):
        E = solve(pose, natural_frequency=wanted_frequency(pose)).E
        system, z, y, Z = facts(pose)
        Mhat = system.M[1:, 1:]
        floor = SMALLEST_INERTIA * np.linalg.eigvalsh(Mhat)[0]
        alpha = (y @ y) / (y @ (Mhat - E) @ z)  # X z = y/alpha

        def free_inertia(gain, Z=Z, Mhat=Mhat, y=y, z=z, alpha=alpha):
            return np.linalg.eigvalsh(Z.T @ (Mhat - gain - np.outer(y, y) / (alpha * (y @ z))) @ Z)[0]

        rng = np.random.default_rng(n)
        assert free_inertia(E) >= floor * (1.0 - 1e-6)
        for _ in range(400):
            change = rng.normal(size=(n - 1, n - 1)) * 10.0 ** rng.uniform(-6.0, 1.0) * np.linalg.norm(Mhat)
            other = E + Z @ (change + change.T) @ Z.T
            if free_inertia(other) < floor:
                continue
            tried += 1
            assert np.linalg.norm(other) >= np.linalg.norm(E) * (1.0 - 1e-12)
    assert tried > 400


@pytest.mark.parametrize("n", [2, 3])
def test_least_gain_against_a_general_optimiser(n):
    """scipy's SLSQP over all entries of E under (Mhat - E) z = y/alpha finds no smaller norm, and the same one.

    1e-6: the optimiser's own tolerance. Poses whose minimum leaves M - E > 0 on its own, so that no bound is active.
    """
    compared = 0
    for pose in compensable_poses(n, 12):
        E = solve(pose, natural_frequency=wanted_frequency(pose)).E
        system, z, y, _ = facts(pose)
        Mhat = system.M[1:, 1:]
        target = Mhat @ z - y * (y @ (Mhat - E) @ z) / (y @ y)
        found = minimize(
            lambda rho: np.sum(symmetric(rho, n) ** 2),
            np.zeros(n * (n + 1) // 2),
            constraints={"type": "eq", "fun": lambda rho, z=z, target=target: symmetric(rho, n) @ z - target},
            method="SLSQP",
            options={"ftol": 1e-15, "maxiter": 500},
        )
        other = symmetric(found.x, n)
        if np.linalg.eigvalsh(Mhat - other)[0] < 0.02 * np.linalg.eigvalsh(Mhat)[0]:
            continue
        compared += 1
        assert upper_triangle(E) == pytest.approx(upper_triangle(other), rel=0.0, abs=1e-5 * np.abs(E).max())
    assert compared >= 3


@pytest.mark.parametrize("n", [2, 3, 4])
def test_least_radius_is_smallest_in_its_family(n):
    """rho(Ms^-1 E) meets the lower bound that any member obeys, and no random member of the family goes below it."""
    tried = 0
    for pose in compensable_poses(n, 12):
        try:
            found = solve(pose, natural_frequency=wanted_frequency(pose, 1.1), objective="least-radius")
        except Infeasible:
            continue
        system, _, _, Z = facts(pose)
        mobility = np.linalg.inv(system.M)[1:, 1:]

        def radius(E, mobility=mobility):
            return np.abs(np.linalg.eigvals(mobility @ E)).max()

        best = radius(found.E)
        assert found.certificate.algebraic_loop_radius == pytest.approx(best, rel=1e-9)
        rng = np.random.default_rng(n)
        for _ in range(200):
            tried += 1
            change = rng.normal(size=(n - 1, n - 1)) * 10.0 ** rng.uniform(-6.0, 1.0) * np.linalg.norm(found.E)
            assert radius(found.E + Z @ (change + change.T) @ Z.T) >= best * (1.0 - 1e-9)
        gain = solve(pose, natural_frequency=wanted_frequency(pose, 1.1))
        assert best <= gain.certificate.algebraic_loop_radius * (1.0 + 1e-9)
        assert np.linalg.norm(gain.E) <= np.linalg.norm(found.E) * (1.0 + 1e-9)
    assert tried >= 600


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("n", [2, 3])
def test_slowest_reachable_frequency_is_sharp(n, sign):
    """A millionth above the bound a gain exists and hits its target; a millionth below none is promised.

    Both cases of the theory, y.z > 0 and -Mpp < y.z < 0. Near the bound the gain is extreme, hence the ordinary 1e-6.
    """
    poses = [pose for pose in compensable_poses(n, 40) if compensability(pose).product * sign > 0.0][:5]
    assert len(poses) >= 2
    for pose in poses:
        slowest = compensability(pose).slowest
        with pytest.raises(Infeasible, match="out of reach") as refusal:
            solve(pose, natural_frequency=slowest * (1.0 - 1e-6))
        bound = float(re.search(r"above ([0-9.]+) rad/s", str(refusal.value)).group(1))
        assert bound == pytest.approx(slowest, abs=5.1e-5)  # printed with four decimals
        above = solve(pose, natural_frequency=slowest * (1.0 + 1e-6))
        reached = np.abs(FullSystem(pose, above.E).vibrations()[0])
        assert reached == pytest.approx(slowest * (1.0 + 1e-6), rel=1e-8)


def test_refusal_is_true_by_search():
    """Where the test says that no gain aligns the mode, a global search over M - E > 0 finds none either.

    Differential evolution maximises the cosine over all X above a twentieth of the arm's smallest inertia (without that
    floor a vanishing X lets |V| grow, and the cosine tends to 1 without reaching it). The control: at compensable
    poses the same function is 1 at the design.
    """

    def cosine(pose, X):
        system = FullSystem(pose)
        Map, Mpp = system.M[1:, 0], system.M[0, 0]
        follow = np.linalg.solve(X, Map)
        if Mpp - Map @ follow <= 0.0:
            return -2.0
        b = system.C[:, 1:] @ follow
        a = b - system.C[:, 0]
        return float(a @ b / (np.linalg.norm(a) * np.linalg.norm(b)))

    def best_cosine(pose):
        Mhat = FullSystem(pose).M[1:, 1:]
        factor, floor = np.linalg.cholesky(Mhat), 0.05 * np.linalg.eigvalsh(Mhat)[0] * np.eye(2)

        def misfit(entries):
            c, s = np.cos(entries[2]), np.sin(entries[2])
            root = factor @ np.array([[c, -s], [s, c]])
            return -cosine(pose, root @ np.diag(10.0 ** entries[:2]) @ root.T + floor)

        bounds = [(-6.0, 4.0), (-6.0, 4.0), (0.0, np.pi)]
        return -differential_evolution(misfit, bounds, seed=0, tol=1e-10, popsize=15, maxiter=40).fun

    for pose in compensable_poses(2, 5):
        assert cosine(pose, FullSystem(pose).M[1:, 1:] - solve(pose).E) == pytest.approx(1.0, abs=1e-12)
    refused = [
        pose
        for pose in (random_pose(seed, 1, 2, 2) for seed in range(300))
        if compensability(pose).product < -1.2 * pose.M[0, 0]
    ][:3]
    assert len(refused) == 3
    for pose in refused:
        with pytest.raises(Infeasible, match=r"no gain aligns the mode here: y\.z = -"):
            solve(pose, natural_frequency=500.0)
        assert 0.0 < best_cosine(pose) < 1.0 - 1e-5


def test_default_frequency_is_reachable_and_raised(paper_pose):
    """Left out, the target is a quarter above the present frequency, or just above the slowest reachable one."""
    for pose in [paper_pose, *compensable_poses(2, 10)]:
        before = flexbase.modes(pose)[0].frequency
        after = solve(pose).certificate.frequency_after_rad_s[0]
        assert after == pytest.approx(max(1.25 * before, 1.02 * compensability(pose).slowest), rel=1e-9)


def test_one_joint_arm_with_its_closed_form():
    """n = 1: X = y/(alpha z) is one number. Sliding pair: y.z = -m2, slowest = sqrt(K/m1), X from omega^2 = K/S."""
    angle, m1, m2, K = 0.9, 12.0, 3.0, 5e4
    pose = sliding_pair(angle, m1, m2, K).at([0.2])
    assert compensability(pose).slowest == pytest.approx(np.sqrt(K / m1), rel=1e-13)
    omega = 80.0
    X = (m2 * np.cos(angle)) ** 2 / (m1 + m2 - K / omega**2)
    found = solve(pose, natural_frequency=omega)
    assert pytest.approx(np.array([[m2 - X]]), rel=1e-12) == found.E


@pytest.mark.parametrize("target", [0.0, -3.0, float("nan"), float("inf")])
def test_a_target_that_is_no_frequency_is_refused(paper_pose, target):
    """Zero, negative, NaN, infinite: wrong input, not an infeasible design."""
    with pytest.raises(InputError, match="natural frequency"):
        flexbase.design(paper_pose, "exact", natural_frequency=target)


def test_scope_is_checked(paper_pose):
    """Several base joints, an unknown objective: InputError with the mend."""
    with pytest.raises(InputError, match=r"2 base joints.*task-priority"):
        solve(random_pose(0, 2, 2, 2))
    with pytest.raises(InputError, match='"least-effort" is unknown'):
        solve(paper_pose, objective="least-effort")
    with pytest.warns(FlexbaseWarning, match="no .base. joints"):
        rigid = planar([0.3, 0.25], m=0)
    with pytest.raises(InputError, match="rigid"):
        solve(rigid.at([0.4, 0.9]))
