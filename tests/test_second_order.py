"""The central object: its state space, its transfer function, its conversion, and the loop closed around it."""

from __future__ import annotations

import numpy as np
import pytest

import flexbase
from flexbase import InputError
from flexbase.linear.closed_loop import abscissa, close_loop
from flexbase.model.loop import Gain
from systems.oracle import FullSystem
from systems.random_plants import random_pose

CASES = [(0, 1, 2, 2), (1, 2, 3, 3), (2, 3, 4, 2), (3, 2, 2, 1)]
FREQUENCIES = np.array([3.0 + 40.0j, -5.0 + 200.0j, 900.0j, 60.0, 2000.0 - 300.0j])


@pytest.fixture(scope="module", params=CASES, ids=str)
def pose(request):
    seed, m, n, k = request.param
    return random_pose(seed, m, n, k)


def test_linear_model_is_the_one_assembled_by_hand(pose):
    """M, D, K, B, C of linearise equal those put together from Pinocchio and the base's numbers, to 1e-10."""
    ours, theirs = flexbase.linearise(pose), FullSystem(pose)
    for name in ("M", "D", "K", "B", "C"):
        wanted = getattr(theirs, name)
        assert getattr(ours, name) == pytest.approx(wanted, rel=0.0, abs=1e-10 * np.abs(wanted).max())


def test_compensator_changes_the_arm_block_and_nothing_else(pose):
    """X = Mhat - E is the whole effect of a compensator.  [U03 eq 11]"""
    m, n = pose.arm.m, pose.arm.n
    E = 0.3 * np.linalg.eigvalsh(pose.M)[0] * np.ones((n, n)) / n
    plain, shaped = flexbase.linearise(pose), flexbase.linearise(pose, Gain(E))
    change = plain.M - shaped.M
    assert change[m:, m:] == pytest.approx(E, rel=1e-12)
    change[m:, m:] = 0.0
    assert not change.any()
    for name in ("D", "K", "B", "C"):
        assert np.array_equal(getattr(plain, name), getattr(shaped, name))


def test_transfer_function_is_that_of_the_state_space(pose):
    """C (sI - A)^-1 B of the state space equals C (M s^2 + D s + K)^-1 B, computed from Pinocchio's matrices.

    1e-9: conditioning of the resolvent at these frequencies is below 1e5.
    """
    system, oracle = flexbase.linearise(pose), FullSystem(pose)
    A, B, C, feedthrough = system.state_space()
    P = system.transfer_function(FREQUENCIES)
    assert P.shape == (len(FREQUENCIES), pose.arm.k, pose.arm.k)
    assert not feedthrough.any()
    for s, ours in zip(FREQUENCIES, P, strict=True):
        wanted = oracle.response(s)
        assert ours == pytest.approx(wanted, rel=0.0, abs=1e-9 * np.abs(wanted).max())
        by_state = C @ np.linalg.solve(s * np.eye(len(A)) - A, B)
        assert by_state == pytest.approx(wanted, rel=0.0, abs=1e-9 * np.abs(wanted).max())


def test_transfer_function_keeps_batch_axes(pose):
    """A grid of frequencies gives a grid of matrices; one frequency gives one matrix."""
    system, grid = flexbase.linearise(pose), 1j * np.linspace(10.0, 900.0, 6).reshape(2, 3)
    P = system.transfer_function(grid)
    assert P.shape == (2, 3, pose.arm.k, pose.arm.k)
    assert P[1, 2] == pytest.approx(system.transfer_function(grid[1, 2]), rel=1e-12)


def test_conversion_to_control_has_names_and_the_same_response(pose):
    """to_control: signals are named by task rows and joints, and python-control's own evaluation agrees to 1e-9."""
    system = flexbase.linearise(pose)
    converted = system.to_control()
    rows, joints = list(pose.arm.task.rows), list(pose.arm.mechanism.joint_names)
    assert converted.input_labels == [f"f_{row}" for row in rows]
    assert converted.output_labels == rows
    assert converted.state_labels == joints + [f"{joint}_rate" for joint in joints]
    omega = np.array([20.0, 150.0, 700.0])
    response = converted.frequency_response(omega, squeeze=False).frdata
    ours = np.moveaxis(system.transfer_function(1j * omega), 0, -1)
    assert response == pytest.approx(ours, rel=0.0, abs=1e-9 * np.abs(ours).max())


def test_closed_loop_is_feedback_of_the_task_error(pose):
    """close_loop puts f = -(Kp y + Kv y') around the plant: its rightmost pole is that of the loop assembled apart.

    1e-6 of the fastest pole over 1e5: eigenvalues of the closed loop are well conditioned, but the redundant arm's
    free motions are double zeros, which rounding spreads to its square root.
    """
    gains = pose.arm.gains
    ours = abscissa(close_loop(flexbase.linearise(pose), gains))
    poles = FullSystem(pose).close(gains.stiffness, gains.damping).poles()
    tolerance = 1e-9 if pose.arm.n == pose.arm.k else 1e-6
    assert ours == pytest.approx(poles.real.max(), rel=0.0, abs=tolerance * np.abs(poles).max())


def test_a_gain_that_makes_the_inertia_indefinite_is_refused(pose):
    """M - E must stay positive definite: the message gives the eigenvalue and the mend."""
    E = 2.0 * pose.M[pose.arm.m :, pose.arm.m :]
    with pytest.raises(InputError, match=r"M - E is not positive definite.*smallest eigenvalue -"):
        flexbase.linearise(pose, Gain(E))


@pytest.mark.parametrize(
    ("E", "message"),
    [
        (np.eye(5), r"E has shape \(5, 5\)"),
        ([[0.0, 1.0], [2.0, 0.0]], "not symmetric"),
        ([[np.nan, 0.0], [0.0, 0.0]], "not finite"),
    ],
)
def test_a_wrong_gain_is_refused(paper_pose, E, message):
    """Wrong size, not symmetric, not finite: one InputError each."""
    with pytest.raises(InputError, match=message):
        flexbase.linearise(paper_pose, Gain(np.array(E)))
