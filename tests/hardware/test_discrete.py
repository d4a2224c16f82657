"""Sampled systems against scipy's discretisation and python-control's connections."""

from __future__ import annotations

import control
import numpy as np
import pytest
import scipy.signal

from flexbase.linear.discrete.system import (
    Discrete,
    delay,
    feedback,
    hold,
    parallel,
    series,
    side_by_side,
    spectral_radius,
    static,
)
from flexbase.linear.second_order import StateSpace

STEP = 2e-3
OMEGA = np.geomspace(1.0, 1500.0, 40)


def plant(states: int, inputs: int, outputs: int, seed: int = 0) -> StateSpace:
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(states, states)) * 20.0
    return StateSpace(
        A - (np.linalg.eigvals(A).real.max() + 1.0) * np.eye(states),
        rng.normal(size=(states, inputs)),
        rng.normal(size=(outputs, states)),
        rng.normal(size=(outputs, inputs)),
    )


def controls(system: Discrete) -> control.StateSpace:
    return control.ss(system.A, system.B, system.C, system.D, system.step)


def response(system: control.StateSpace) -> np.ndarray:
    values = np.array([system(np.exp(1j * w * STEP), squeeze=False) for w in OMEGA])
    return values.reshape(len(OMEGA), system.noutputs, system.ninputs)


def test_hold_is_scipys() -> None:
    system = plant(5, 2, 3)
    found = hold(system, STEP)
    A, B, C, D, _ = scipy.signal.cont2discrete(tuple(system), STEP)
    for mine, theirs in zip((found.A, found.B, found.C, found.D), (A, B, C, D), strict=True):
        assert mine == pytest.approx(theirs, rel=1e-12, abs=1e-12)


def test_connections_are_controls() -> None:
    """Frequency responses to 1e-10: the same rational functions, other states."""
    P, K = hold(plant(4, 2, 3), STEP), hold(plant(3, 3, 2, 1), STEP)
    small = Discrete(K.A, K.B, 0.02 * K.C, 0.02 * K.D, STEP)
    assert series(P, K).transfer_function(OMEGA) == pytest.approx(response(controls(K) * controls(P)), rel=1e-10)
    other = hold(plant(2, 2, 3, 5), STEP)
    assert parallel(P, other).transfer_function(OMEGA) == pytest.approx(
        response(controls(P) + controls(other)), rel=1e-10
    )
    assert side_by_side(P, K).transfer_function(OMEGA) == pytest.approx(
        response(control.append(controls(P), controls(K))), rel=1e-10, abs=1e-14
    )
    closed = feedback(P, small)
    assert closed.transfer_function(OMEGA) == pytest.approx(
        response(control.feedback(controls(P), controls(small), 1)), rel=1e-9
    )
    assert spectral_radius(closed.A) == pytest.approx(
        np.abs(control.feedback(controls(P), controls(small), 1).poles()).max(), rel=1e-9
    )


def test_external_inputs_pass_by_the_controller() -> None:
    """y = P [K y + d; w]: the last input enters the plant alone."""
    P = hold(plant(4, 3, 2), STEP)
    K = static(0.05 * np.ones((2, 2)), STEP)
    found = feedback(P, K, external=1).transfer_function(OMEGA)
    G = P.transfer_function(OMEGA)
    gain = np.linalg.inv(np.eye(2) - G[:, :, :2] @ K.D)
    assert found == pytest.approx(gain @ G, rel=1e-9)


@pytest.mark.parametrize("samples", [0, 1, 3])
def test_delay(samples: int) -> None:
    found = delay(2, samples, STEP).transfer_function(OMEGA)
    expected = np.exp(-1j * OMEGA * STEP * samples)[:, None, None] * np.eye(2)
    assert found == pytest.approx(expected, abs=1e-12)


def test_static_gain_is_what_a_long_wait_shows() -> None:
    system = hold(plant(4, 2, 2), STEP)
    x, u = np.zeros(4), np.array([1.0, -2.0])
    for _ in range(40_000):
        x = system.A @ x + system.B @ u
    assert system.static_gain() @ u == pytest.approx(system.C @ x + system.D @ u, rel=1e-9)
