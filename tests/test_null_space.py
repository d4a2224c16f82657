"""Self-motion control of redundant arms: passivity covers it together with the task's.  [theory §7]"""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

import flexbase
from flexbase import FlexbaseWarning, Infeasible, InputError
from flexbase.control.measured import Measured
from flexbase.control.null_space import NullSpaceDamping, Sum, null_space_damping, self_motions, shares_one_beta
from flexbase.control.task_pd import TaskPD
from flexbase.errors import FlexbaseError
from flexbase.linear.closed_loop import abscissa, close_loop
from flexbase.linear.linearise import linearise
from flexbase.model.loop import Gain
from systems.oracle import FullSystem
from systems.passivity import least_eigenvalue
from systems.random_plants import random_pose
from systems.six_joint import random_poses, six_joint

pytest.importorskip("cvxpy")
BASES = [("px",), ("ry",), ("px", "py"), ("rx", "ry"), ("px", "py", "pz"), ("rx", "ry", "rz")]
FREQUENCY = 20.0  # rad/s of the self-motion by itself
GAINS = [
    (task, motion, ratio) for task in np.geomspace(1.0, 1e4, 5) for motion in (1e-4, 1.0, 1e4) for ratio in (0.1, 1.0)
]


def solve(pose, method="convex", **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlexbaseWarning)
        return flexbase.design(pose, method, **options)


def orthogonal(pose, E):
    """The usual choice: damping along the null space of Jv, W = N^T up to the scale that makes its inertia 1."""
    N = np.linalg.svd(pose.J[:, pose.arm.m :])[2][pose.arm.k :]
    root = np.linalg.cholesky(N @ (pose.M[pose.arm.m :, pose.arm.m :] - E) @ N.T)
    eye = np.eye(len(N))
    return NullSpaceDamping(pose, root.T @ N, FREQUENCY**2 * eye, 1.4 * FREQUENCY * eye)


def stable_at_every_gain(pose, E, law):
    """Task gains to 1e4 times their size, damping by its root and a tenth of that; the self-motion's independently."""
    system, gains = linearise(pose, Gain(E)), pose.arm.gains
    for task, motion, ratio in GAINS:
        scaled = replace(gains, stiffness=task * gains.stiffness, damping=np.sqrt(task) * ratio * gains.damping)
        moved = replace(law, stiffness=motion * law.stiffness, damping=np.sqrt(motion) * law.damping)
        values = np.linalg.eigvals(moved.close(close_loop(system, scaled)).state_space().A)
        if values.real.max() > 1e-11 * np.abs(values).max():
            return False
    return True


def augmented(pose, E, W, weight=1.0):
    """Least eigenvalue of (f, g) -> (y', weight W q_a'), by the sweep; the masses are Pinocchio's."""
    system, m = FullSystem(pose, E), pose.arm.m
    blind = np.hstack([np.zeros((len(W), m)), W])
    return least_eigenvalue(
        system.M, system.D, system.K, np.hstack([system.B, blind.T]), np.vstack([system.C, weight * blind])
    )


@pytest.mark.parametrize("kind", ["blind", "consistent"])
def test_the_defining_equations(kind):
    """W Y Map = 0 or W Y Jv^T = 0, W N = I, and [Jv; W] invertible, under a gain and without."""
    for seed in range(6):
        pose = random_pose(seed, 2, 6, 3)
        m, arm = 2, FullSystem(pose)
        for E in (np.zeros((6, 6)), solve(pose, "bounded").E):
            W = null_space_damping(pose, Gain(E), frequency=FREQUENCY, kind=kind).W
            Y, Jv = np.linalg.inv(arm.M[m:, m:] - E), arm.C[:, m:]
            forbidden = Y @ (arm.M[m:, :m] if kind == "blind" else Jv.T)
            assert np.abs(W @ forbidden).max() < 1e-9 * np.linalg.norm(W) * np.linalg.norm(forbidden)
            N = self_motions(pose, E)
            assert np.abs(Jv @ N).max() < 1e-9 * np.abs(N).max()
            assert pytest.approx(np.eye(3), rel=0.0, abs=1e-8) == W @ N
            assert np.linalg.matrix_rank(np.vstack([Jv, W])) == 6


def test_the_augmented_plant_is_positive_real():
    """Blind as it is, consistent once W q_a' is weighted by (beta - 1)/beta; the control, orthogonal, is not.

    Brute-force sweep of the whole (n x n) response at full, non-proportional damping.
    """
    checked, controls = 0, 0
    for seed in range(12):
        pose = random_pose(seed, 2, 6, 3)
        try:
            E = solve(pose, objective="aligned").E
        except Infeasible:
            continue
        m, system = 2, FullSystem(pose, E)
        V = system.C[:, m:] @ np.linalg.solve(system.M[m:, m:], system.M[m:, :m])
        beta = np.sum(V * system.C[:, :m]) / np.sum(system.C[:, :m] ** 2)
        assert shares_one_beta(pose, E)
        checked += 1
        blind, consistent = (
            null_space_damping(pose, Gain(E), frequency=FREQUENCY, kind=kind).W for kind in ("blind", "consistent")
        )
        assert augmented(pose, E, blind) > -1e-8
        assert augmented(pose, E, consistent, (beta - 1.0) / beta) > -1e-8
        controls += augmented(pose, E, orthogonal(pose, E).W) < -1e-3
    assert checked >= 5
    assert controls >= checked - 1


@pytest.mark.slow
def test_stable_at_every_gain_where_the_usual_choice_is_not():
    """24 poses of a six-joint arm, k = 3, base damping 0.2 %: never unstable where a W exists, to 1e4 times the gains.

    Without E, or with E and orthogonal damping, a good part is unstable. The turning base (rx ry rz) does not feel a
    turn about the line to the tip, so blind W does not exist there; consistent W does, where one beta serves all modes.
    """
    plain = usual = ours = refused = 0
    for number, base in enumerate(BASES):
        for pose in random_poses(six_joint(base, 3, damping=0.002), 4, seed=number):
            E = solve(pose).E
            none = np.zeros_like(E)
            plain += stable_at_every_gain(pose, none, orthogonal(pose, none))
            usual += stable_at_every_gain(pose, E, orthogonal(pose, E))
            try:
                law = null_space_damping(pose, Gain(E), frequency=FREQUENCY)
            except Infeasible:
                refused += 1
                continue
            assert stable_at_every_gain(pose, E, law), base
            ours += 1
    assert ours + refused == 24
    assert ours >= 22
    assert plain <= 12
    assert usual <= 18


def test_where_no_blind_choice_exists_it_is_refused():
    """More base joints than task rows, or a base that turns about the tip: Infeasible with the ranks, and the mend."""
    pose = random_pose(0, 3, 6, 2)
    with pytest.raises(Infeasible, match=r"moves 3 motions of the base, the 2 task rows feel 2"):
        null_space_damping(pose, frequency=FREQUENCY)
    turning = random_poses(six_joint(("rx", "ry", "rz"), 3), 6)
    for pose in turning:
        try:
            gain = solve(pose, objective="aligned")
        except Infeasible:
            continue
        with pytest.raises(Infeasible, match="feel 2 of them"):
            null_space_damping(pose, gain, frequency=FREQUENCY, kind="blind")
        assert shares_one_beta(pose, gain.E)
        assert stable_at_every_gain(pose, gain.E, null_space_damping(pose, gain, frequency=FREQUENCY))
        return
    raise AssertionError("no aligned pose to test")


def test_the_law_is_its_linear_model():
    """torque = -(W^T stiffness W dq + W^T damping W q'), one instant and a batch; `close` adds the same matrices."""
    pose = random_pose(1, 2, 5, 3)
    law = null_space_damping(pose, frequency=FREQUENCY, damping_ratio=0.5)
    rng = np.random.default_rng(0)
    offset, rates = rng.normal(size=(2, 5, 7))
    seen = Measured(0.0, tuple(pose.q[2:, None] + offset), tuple(rates), (0.0,) * 3, (0.0,) * 3)
    expected = -law.W.T @ (FREQUENCY**2 * law.W @ offset + FREQUENCY * law.W @ rates)
    assert np.array(law.torque(seen)) == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())
    closed, system = law.close(linearise(pose)), linearise(pose)
    assert (closed.K - system.K)[2:, 2:] @ offset + (closed.D - system.D)[2:, 2:] @ rates == pytest.approx(-expected)
    assert not (closed.K - system.K)[:2].any()
    assert not (closed.D - system.D)[:, :2].any()


def test_two_laws_add():
    """Sum's torque is the two torques' sum."""
    pose = random_pose(1, 2, 5, 3)
    task, law = TaskPD(pose, pose.arm.gains), null_space_damping(pose, frequency=FREQUENCY)
    seen = Measured(0.0, tuple(pose.q[2:] + 0.1), (0.2,) * 5, (0.01,) * 3, (0.3,) * 3)
    total = np.array(Sum(task, law).torque(seen))
    assert total == pytest.approx(np.array(task.torque(seen)) + np.array(law.torque(seen)), rel=1e-12)


def test_the_self_motion_settles_at_its_own_frequency():
    """Along N the law is frequency^2 and 2 damping_ratio frequency of a unit inertia, and no drift is left."""
    pose = random_pose(2, 1, 4, 2)
    law = null_space_damping(pose, frequency=FREQUENCY, damping_ratio=0.6, kind="consistent")
    N = self_motions(pose, np.zeros((4, 4)))
    stiffness, damping = (N.T @ law.W.T @ part @ law.W @ N for part in (law.stiffness, law.damping))
    assert stiffness == pytest.approx(FREQUENCY**2 * np.eye(2), rel=1e-9, abs=1e-6)
    assert damping == pytest.approx(1.2 * FREQUENCY * np.eye(2), rel=1e-9, abs=1e-6)
    drifting = linearise(pose, solve(pose))
    held = null_space_damping(pose, solve(pose), frequency=FREQUENCY).close(close_loop(drifting, pose.arm.gains))
    assert abscissa(close_loop(drifting, pose.arm.gains)) > -1e-3  # the self-motion's poles are at 0
    assert abscissa(held) < -0.1


def test_scope_and_options_are_checked(paper_pose):
    """An arm without self-motion, an unknown kind, a frequency or ratio that is none."""
    pose = random_pose(1, 1, 4, 3)
    for at, options, message in (
        (paper_pose, {"frequency": 10.0}, "leave no self-motion"),
        (pose, {"frequency": 10.0, "kind": "best"}, '"best" is unknown'),
        (pose, {"frequency": 0.0}, "null-space frequency"),
        (pose, {"frequency": 10.0, "damping_ratio": -1.0}, "null-space damping ratio"),
    ):
        with pytest.raises(InputError, match=message):
            null_space_damping(at, **options)
    assert issubclass(Infeasible, FlexbaseError)
