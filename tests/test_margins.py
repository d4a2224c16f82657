"""Can it be built: algebraic-loop radii and lag margins against brute force.  [theory §8]"""

from __future__ import annotations

import numpy as np
import pytest

from flexbase.linear.margins import (
    algebraic_loop_radius,
    algebraic_loop_radius_per_joint,
    closed_loop_abscissa,
    lag_margin,
)
from systems.oracle import FullSystem
from systems.random_plants import random_pose

SHAPES = [(1, 2), (2, 2), (1, 3), (2, 4)]


def random_gain(pose, seed, size=0.9):
    """Symmetric E whose algebraic-loop radius is about `size`: E = L F L^T with Ms = L L^T."""
    F = np.random.default_rng(seed).normal(size=(pose.arm.n, pose.arm.n))
    F = F + F.T
    L = np.linalg.cholesky(pose.Ms)
    return size * L @ F @ L.T / np.abs(np.linalg.eigvalsh(F)).max()


def gain_around(pose, E):
    """Ms^-1 E with Ms from Pinocchio: Ms^-1 is the arm's block of the inverse of the full inertia."""
    m = pose.arm.m
    return np.linalg.inv(FullSystem(pose).M)[m:, m:] @ E


@pytest.mark.parametrize(("m", "n"), SHAPES)
def test_common_delay_radius_by_eigenvalues(m, n):
    """rho = max |eig(Ms^-1 E)|, with Ms^-1 read from the inverse of the whole inertia, to 1e-10."""
    for seed in range(5):
        pose = random_pose(seed, m, n, 2)
        E = random_gain(pose, seed, 0.7)
        rho = algebraic_loop_radius(pose, E)
        assert rho == pytest.approx(np.abs(np.linalg.eigvals(gain_around(pose, E))).max(), rel=1e-10)
        assert rho == pytest.approx(0.7, rel=1e-10)  # by construction


@pytest.mark.parametrize(("m", "n"), SHAPES)
def test_unequal_delays_are_never_easier(m, n):
    """mu >= rho: equal delays are one of the choices. Strictly larger somewhere, or mu would be a copy of rho."""
    gaps = []
    for seed in range(16):
        pose = random_pose(seed, m, n, 2)
        E = random_gain(pose, seed)
        gaps.append(algebraic_loop_radius_per_joint(pose, E) - algebraic_loop_radius(pose, E))
    assert min(gaps) >= -1e-12
    assert max(gaps) > 1e-3


def test_unequal_delay_radius_of_two_joints_by_a_phase_grid():
    """n = 2: mu is the largest radius over one relative phase. 20001 points miss the top by under 1e-7 of it."""
    phases = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 20001))
    for seed in range(8):
        pose = random_pose(seed, 1, 2, 2)
        E = random_gain(pose, seed, 1.3)
        turned = np.repeat(gain_around(pose, E)[None].astype(complex), len(phases), axis=0)
        turned[:, :, 1] *= phases[:, None]
        brute = np.abs(np.linalg.eigvals(turned)).max()
        assert algebraic_loop_radius_per_joint(pose, E) == pytest.approx(brute, rel=1e-6)


def test_unequal_delay_radius_of_three_joints_by_a_phase_grid():
    """n = 3: a grid of 240 x 240 relative phases is a lower bound, within 1e-3 of the top."""
    phases = np.exp(2j * np.pi * np.arange(240) / 240)
    for seed in range(3):
        pose = random_pose(seed, 1, 3, 3)
        E = random_gain(pose, seed)
        A = gain_around(pose, E)
        brute = 0.0
        for first in phases:
            turned = np.repeat(A[None].astype(complex), len(phases), axis=0)
            turned[:, :, 1] *= first
            turned[:, :, 2] *= phases[:, None]
            brute = max(brute, np.abs(np.linalg.eigvals(turned)).max())
        mu = algebraic_loop_radius_per_joint(pose, E)
        assert brute - 1e-9 <= mu <= brute * (1.0 + 1e-3)


@pytest.mark.parametrize(("m", "n", "k"), [(1, 2, 2), (2, 3, 3), (2, 2, 2)])
def test_closed_loop_abscissa_is_the_rightmost_pole(m, n, k):
    """With E and the gains, to 1e-9 of the fastest pole of the loop assembled from Pinocchio."""
    for seed in range(4):
        pose = random_pose(seed, m, n, k)
        gains, E = pose.arm.gains, random_gain(pose, seed, 0.6)
        poles = FullSystem(pose, E).close(gains.stiffness, gains.damping).poles()
        ours = closed_loop_abscissa(pose, E, gains)
        assert ours == pytest.approx(poles.real.max(), rel=0.0, abs=1e-9 * np.abs(poles).max())


def lagged_abscissa(pose, E, gains, lag):
    return FullSystem(pose, E).close(gains.stiffness, gains.damping).lagged_poles(lag).real.max()


def test_lag_margin_separates_stable_from_unstable():
    """Stable with any lag up to just below the margin, unstable just above it, by an independent cubic eigenproblem.

    The random plants must give all three answers: a finite margin, none, and a loop that is unstable without lag.
    """
    answers = set()
    for seed in range(24):
        pose = random_pose(seed, 1, 2, 2, damping="full")
        gains, E = pose.arm.gains, random_gain(pose, seed, 0.8)
        margin = lag_margin(pose, E, gains)
        ideal = FullSystem(pose, E).close(gains.stiffness, gains.damping).poles().real.max()
        if ideal >= 0.0:
            assert margin == 0.0
            answers.add("unstable")
        elif margin is None:
            assert max(lagged_abscissa(pose, E, gains, lag) for lag in np.geomspace(1e-5, 1.0, 60)) < 0.0
            answers.add("none")
        elif margin > 0.0:
            lags = margin * np.concatenate([np.geomspace(1e-3, 0.9, 30), [1.0 - 1e-5]])
            assert max(lagged_abscissa(pose, E, gains, lag) for lag in lags) < 0.0
            assert lagged_abscissa(pose, E, gains, margin * (1.0 + 1e-5)) > 0.0
            answers.add("finite")
    assert answers == {"unstable", "none", "finite"}


def test_no_gain_leaves_no_lag_to_speak_of(paper, paper_pose):
    """E = 0: radii are zero, and the lag margin only says whether the loop is stable (here it is not)."""
    zero = np.zeros((2, 2))
    assert algebraic_loop_radius(paper_pose, zero) == algebraic_loop_radius_per_joint(paper_pose, zero) == 0.0
    assert lag_margin(paper_pose, zero, paper.arm.gains) == 0.0
    pose = random_pose(0, 1, 2, 2)
    stable = FullSystem(pose).close(pose.arm.gains.stiffness, pose.arm.gains.damping).poles().real.max() < 0.0
    assert (lag_margin(pose, zero, pose.arm.gains) is None) == stable
