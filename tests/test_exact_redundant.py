"""The exact design of redundant arms, n > k, on one base joint: targets, radius and refusals.  [theory §7]"""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

import flexbase
from flexbase import FlexbaseWarning, Infeasible
from systems.oracle import FullSystem
from systems.passivity import loop_radius, passivity
from systems.random_plants import random_pose

SIZES = [(3, 2), (4, 3), (6, 3), (7, 6), (5, 1)]


def solve(pose, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlexbaseWarning)
        return flexbase.design(pose, "exact", **options)


def turn_and_beta(pose, E):
    """V and beta of V = beta Jp with the relative misfit, from Pinocchio's matrices."""
    system = FullSystem(pose, E)
    V = system.C[:, 1:] @ np.linalg.solve(system.M[1:, 1:], system.M[1:, 0])
    Jp = system.C[:, 0]
    beta = V @ Jp / (Jp @ Jp)
    return beta, np.linalg.norm(V - beta * Jp) / np.linalg.norm(Jp)


@pytest.mark.parametrize("objective", ["least-gain", "least-radius"])
@pytest.mark.parametrize(("n", "k"), SIZES)
def test_both_targets_hold(n, k, objective):
    """omega to 1e-8, V = beta Jp to 1e-8 with beta outside [0, 1], M - E > 0, no negative eigenvalue in a sweep."""
    solved = 0
    for seed in range(10):
        pose = random_pose(seed, 1, n, k)
        if np.abs(pose.J[:, 0]).max() < 1e-12:
            continue  # the base does not move the tip
        target = 1.2 * flexbase.modes(pose)[0].frequency
        try:
            E = solve(pose, natural_frequency=target, objective=objective).E
        except Infeasible as refusal:
            assert "no longer positive" in str(refusal)  # noqa: PT017
            continue
        solved += 1
        system = FullSystem(pose, E)
        assert np.linalg.eigvalsh(system.M)[0] > 0.0
        assert abs(system.vibrations()[0]) == pytest.approx(target, rel=1e-8)
        beta, misfit = turn_and_beta(pose, E)
        assert misfit < 1e-8
        assert beta < 0.0 or beta > 1.0
        assert passivity(pose, E) > -1e-8
    assert solved >= 6


@pytest.mark.parametrize(("n", "k"), SIZES[:4])
def test_the_radius_is_the_smallest_of_the_family(n, k):
    """No other self-motion, with the best gain for it, and no other gain of the family has a smaller radius.

    The bound for any t with Jv t = alpha Jp and y.t = sigma is |L^-1 (Mhat t - y)| / |L^T t|: tried at random.
    """
    rng, tried = np.random.default_rng(0), 0
    for seed in range(10):
        pose = random_pose(seed, 1, n, k)
        target = 1.2 * flexbase.modes(pose)[0].frequency
        try:
            best = loop_radius(pose, solve(pose, natural_frequency=target, objective="least-radius").E)
        except Infeasible:
            continue
        if best >= 1.0:
            continue  # the infimum is 1 and not attained
        system = FullSystem(pose)
        Mhat, y = system.M[1:, 1:], -system.M[1:, 0]
        sigma = system.M[0, 0] - pose.arm.base.stiffness[0, 0] / target**2
        L = np.linalg.cholesky(np.linalg.inv(np.linalg.inv(system.M)[1:, 1:]))
        z = np.linalg.pinv(system.C[:, 1:]) @ system.C[:, 0]
        N = np.linalg.svd(system.C[:, 1:])[2][k:].T
        for _ in range(150):
            t = rng.normal() * z / np.linalg.norm(z) + N @ rng.normal(size=n - k)
            t *= sigma / (y @ t)
            alpha = np.linalg.lstsq(np.column_stack([z, N]), t, rcond=None)[0][0]
            if -1.1 < alpha < 0.1:
                continue
            tried += 1
            assert np.linalg.norm(np.linalg.solve(L, Mhat @ t - y)) >= best * np.linalg.norm(L.T @ t) * (1.0 - 1e-9)
    assert tried >= 150


def test_the_slowest_reachable_frequency_is_that_of_the_locked_arm():
    """Just above sqrt(Kp/Mpp) a gain exists, below it the design is refused and the bound is named."""
    pose = random_pose(1, 1, 5, 3)
    slowest = np.sqrt(pose.arm.base.stiffness[0, 0] / FullSystem(pose).M[0, 0])
    with pytest.raises(Infeasible, match="out of reach") as refusal:
        solve(pose, natural_frequency=slowest * (1.0 - 1e-6))
    assert float(re.search(r"above ([0-9.]+) rad/s", str(refusal.value)).group(1)) == pytest.approx(slowest, abs=5.1e-5)
    found = solve(pose, natural_frequency=slowest * 1.001)
    assert abs(FullSystem(pose, found.E).vibrations()[0]) == pytest.approx(slowest * 1.001, rel=1e-8)
