"""Passivity indices of any stable state space: closed forms, dense sweeps, python-control's matrix inequalities."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import flexbase as fb
from flexbase.linear.passivity.passivity_index import input_index, largest_gain, output_index
from flexbase.linear.passivity.stable_part import Port, compressed
from systems.dense_sweep import grid, least_eigenvalue, lowest


def state_port(A, B, C, D=None):
    """The port of a stable state space with as many outputs as inputs."""
    D = np.zeros((B.shape[1], B.shape[1])) if D is None else D

    def response(omega):
        s = 1j * np.asarray(omega)[..., None, None]
        moved = np.linalg.solve(s * np.eye(len(A)) - A, np.broadcast_to(B + 0j, (*np.shape(omega), *B.shape)))
        return C @ moved + D

    return compressed(Port(A, B, C, D, response, B.shape[1]))


def random_state_space(rng: np.random.Generator, order: int, k: int, feed: float):
    A = rng.normal(size=(order, order))
    A -= (np.linalg.eigvals(A).real.max() + rng.uniform(0.05, 0.5)) * np.eye(order)
    D = feed * (np.eye(k) + 0.3 * rng.normal(size=(k, k)))
    return A, rng.normal(size=(order, k)), rng.normal(size=(k, order)), D


def oscillator(damping: float, shift: float = 0.0) -> fb.SecondOrder:
    one = np.ones((1, 1))
    return fb.SecondOrder(one, damping * one, one * (1.0 + shift), one, one, ("q",), ("f",), ("y",))


def test_check_case_of_the_theory():
    """s/(s^2 + 0.2 s + 1): output index 0.2, input index 0, gain 5.  [theory §5]"""
    found = fb.verdict(oscillator(0.2))
    assert found.output_index == pytest.approx(0.2, abs=1e-9)
    assert found.input_index == 0.0
    assert found.largest_gain == pytest.approx(5.0, rel=1e-12)
    assert found.positive_real


@pytest.mark.parametrize("damping", [1e-3, 0.2, 3.0])
def test_output_index_of_several_oscillators(damping):
    """U Z^-1 U^T with square U: G^-1 = U^-T (S s + D + K/s) U^-1, so the index is lambda_min(U^-T D U^-1)."""
    for seed in range(5):
        rng = np.random.default_rng(seed)
        S, K, D = (root @ root.T + 0.2 * np.eye(3) for root in rng.normal(size=(3, 3, 3)))
        U = rng.normal(size=(3, 3)) + 2.0 * np.eye(3)
        system = fb.SecondOrder(S, damping * D, 50.0 * K, U.T, U, ("q",) * 3, ("f",) * 3, ("y",) * 3)
        inverse = np.linalg.inv(U)
        wanted = np.linalg.eigvalsh(inverse.T @ (damping * D) @ inverse)[0]
        assert fb.verdict(system).output_index == pytest.approx(wanted, rel=1e-9, abs=1e-9)


def test_rigid_motion_caps_the_output_index_at_zero(paper_pose):
    """With R0/s no feedback may be taken off; where the skew part at high frequency is not 0 none is enough."""
    assert fb.verdict(paper_pose).output_index == -np.inf
    aligned = fb.design(paper_pose, "exact", natural_frequency=346.8)
    assert fb.verdict(paper_pose, aligned).output_index == pytest.approx(0.0, abs=1e-9)


def test_negative_output_index_against_a_sweep():
    """One row is never skew: a finite negative index, lambda_min of the Hermitian part of G^-1 by a sweep."""
    from systems.random_plants import random_pose

    seen = 0
    for seed in range(12):
        pose = random_pose(seed, 2, 4, 1)
        found, system = fb.verdict(pose), fb.linearise(pose)
        poles = np.linalg.eigvals(system.state_space().A)
        poles = poles[(poles.imag > 0.0) & (np.abs(poles) > 1e-3 * np.abs(poles).max())]
        zeros_too = np.concatenate([poles, poles * np.linspace(0.8, 1.25, 9)[:, None].ravel()[0]])

        def resistance(omega, system=system):
            return np.real(1.0 / (1j * omega * system.transfer_function(1j * omega)[:, 0, 0]))

        wanted = min(0.0, lowest(resistance, grid(zeros_too, 1500)))
        assert found.output_index == pytest.approx(wanted, rel=1e-6, abs=1e-7)
        seen += wanted < -1.0
    assert seen > 3


@pytest.mark.parametrize("k", [1, 2, 3])
def test_input_index_and_gain_with_feedthrough(k):
    """Any stable state space with D: against a sweep to 1e-8 of the gain, of either sign."""
    signs = set()
    for seed in range(9):
        A, B, C, D = random_state_space(np.random.default_rng([seed, k]), 5, k, 20.0 if seed % 3 else 0.0)
        port = compressed(state_port(A, B, C, D))
        gain = largest_gain(port)
        poles = np.linalg.eigvals(A)
        omega = np.append(1e-9, grid(poles[poles.imag >= 0.0]))

        def response(w, A=A, B=B, C=C, D=D):
            s = 1j * w[:, None, None] * np.eye(len(A))
            return C @ np.linalg.solve(s - A, np.broadcast_to(B + 0j, (len(w), *B.shape))) + D

        high = np.linalg.norm(D, 2), np.linalg.eigvalsh(0.5 * (D + D.T))[0]
        wanted = max(high[0], -lowest(lambda w, f=response: -np.linalg.svd(f(w), compute_uv=False)[:, 0], omega))
        nu = min(high[1], lowest(lambda w, f=response: least_eigenvalue(f, w), omega))
        found = input_index(port, gain.value)
        assert gain.value == pytest.approx(wanted, rel=1e-8)
        assert found.value == pytest.approx(nu, abs=1e-8 * gain.value)
        assert found.settled
        signs.add(bool(found.value > 0.0))
    assert signs == {True, False}


def test_directions_without_a_response_are_left_out():
    """Rank two of four rows: lambda_min is at most 0 there, and the pencil stays regular."""
    rng = np.random.default_rng(1)
    A, B, C, _ = random_state_space(rng, 4, 2, 0.0)
    Q = np.linalg.qr(rng.normal(size=(4, 2)))[0]
    whole, small = state_port(A, B @ Q.T, Q @ C), state_port(A, B, C)
    whole = compressed(whole)
    assert len(whole.D) == 2
    gain = largest_gain(small).value
    assert largest_gain(whole).value == pytest.approx(gain, rel=1e-12)
    assert input_index(whole, gain).value == pytest.approx(min(input_index(small, gain).value, 0.0), abs=1e-9 * gain)


@pytest.fixture(scope="module")
def control():
    """python-control with its matrix inequalities, which need cvxopt."""
    pytest.importorskip("cvxopt")
    return pytest.importorskip("control")


@pytest.mark.parametrize("k", [1, 2])
def test_python_control_agrees_on_the_input_index(control, k):
    """`get_input_ff_index` and `ispassive` where D > 0 keeps the matrix inequality well-posed: to 1e-4 of the gain."""
    compared = 0
    for seed in range(10):
        A, B, C, D = random_state_space(np.random.default_rng([seed, 7]), 3, k, 6.0)
        port = compressed(state_port(A, B, C, D))
        gain = largest_gain(port).value
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            system = control.ss(A, B, C, D)
            theirs = control.get_input_ff_index(system)
        ours = input_index(port, gain).value
        assert ours == pytest.approx(theirs, abs=1e-4 * gain)
        if abs(ours) > 1e-3 * gain:
            assert bool(control.ispassive(system)) == (ours > 0.0)
            compared += 1
    assert compared > 5


def test_python_control_agrees_on_the_output_index(control):
    """Oscillators force to velocity: their inequality to 1e-4, ours exact."""
    for damping in (0.2, 1.0):
        system = oscillator(damping)
        one = np.array([[1.0]])
        A = np.array([[0.0, 1.0], [-1.0, -damping]])
        theirs = control.get_output_fb_index(control.ss(A, [[0.0], [1.0]], [[0.0, 1.0]], 0.0 * one))
        assert theirs == pytest.approx(damping, abs=1e-4)
        assert fb.verdict(system).output_index == pytest.approx(theirs, abs=1e-4)
        port = state_port(A, np.array([[0.0], [1.0]]), np.array([[0.0, 1.0]]))
        assert output_index(port, largest_gain(port).value) == pytest.approx(damping, abs=1e-9)
