"""Periodic systems: their response to aliased frequencies against a simulation, their margins against changed loops."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.linear.discrete.disk_margin import disk_margin
from flexbase.linear.discrete.harmonic import periodic
from flexbase.linear.discrete.system import Discrete, series
from flexbase.model.sensing import Sensing
from flexbase.sampled.closed import close_loop, sensitivities
from flexbase.sampled.controller import SampledController
from flexbase.synthesis import controller_for

STEP = 1e-3


def drawn(seed: int) -> Discrete:
    draw = np.random.default_rng(seed)
    A = draw.standard_normal((3, 3))
    A *= 0.7 / np.abs(np.linalg.eigvals(A)).max()
    return Discrete(A, draw.standard_normal((3, 2)), draw.standard_normal((2, 3)), draw.standard_normal((2, 2)), STEP)


@pytest.mark.parametrize("samples", [2, 3])
def test_response_to_aliased_frequencies_is_the_simulation_s(samples: int) -> None:
    """An input of one of the aliased frequencies, 60 periods in: its output holds what the columns say (1e-8)."""
    steps = [drawn(seed) for seed in range(samples)]
    omega = 0.3 * np.pi / (samples * STEP)
    H = periodic(steps).transfer_function(np.array([omega]))[0]
    turns = omega * STEP + 2.0 * np.pi * np.arange(samples) / samples
    for component in range(samples):
        for channel in range(2):
            x, seen = np.zeros(3, dtype=complex), []
            for sample in range(60 * samples):
                u = np.zeros(2, dtype=complex)
                u[channel] = np.exp(1j * turns[component] * sample)
                one = steps[sample % samples]
                seen.append(one.C @ x + one.D @ u)
                x = one.A @ x + one.B @ u
            last = np.arange(59 * samples, 60 * samples)
            parts = np.exp(-1j * turns[:, None] * last) @ np.array(seen)[last] / samples
            np.testing.assert_allclose(H[:, 2 * component + channel], parts.ravel(), atol=1e-8)


def test_a_system_that_does_not_change_answers_each_frequency_by_itself() -> None:
    """Block-diagonal, with the system's own response in each block."""
    one = drawn(0)
    omega = 0.4 * np.pi / (3 * STEP)
    H = periodic([one] * 3).transfer_function(np.array([omega]))[0]
    alone = one.transfer_function(omega + 2.0 * np.pi * np.arange(3) / (3 * STEP))
    expected = np.zeros((6, 6), dtype=complex)
    for i in range(3):
        expected[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] = alone[i]
    np.testing.assert_allclose(H, expected, atol=1e-12)


@pytest.fixture(scope="module")
def slow_camera(paper_pose: fb.Pose) -> SampledController:
    return controller_for(paper_pose, "coprime", Sensing(rate=4000.0, task_every=4))


def test_margins_of_one_rate_do_not_depend_on_how_it_is_counted(paper_pose: fb.Pose) -> None:
    for side in sensitivities(paper_pose, controller_for(paper_pose, "coprime", Sensing())):
        assert disk_margin(periodic([side] * 3)).alpha == pytest.approx(disk_margin(side).alpha, rel=1e-6)


def test_a_slow_task_sensor_s_margin_is_a_promise(slow_camera: SampledController) -> None:
    """No all-pass on the disk's border destabilises; and 5 % outside, some phases at one frequency do."""
    alpha = disk_margin(sensitivities(slow_camera.pose, slow_camera)[0]).alpha
    draw = np.random.default_rng(0)

    def radius(size: float, pole: np.ndarray, sign: np.ndarray) -> float:
        """Torques through (1 + size a/2)/(1 - size a/2), a = sign (1 - pole z)/(z - pole): on the disk's border."""
        a = (1.0 + 0.5 * size * sign * pole) ** -1
        top = np.array([1.0 - 0.5 * size * sign * pole, -pole + 0.5 * size * sign])
        bottom = np.array([1.0 + 0.5 * size * sign * pole, -pole - 0.5 * size * sign])
        A, D = np.diag(-bottom[1] * a), np.diag(top[0] * a)
        C = np.diag((top[1] - top[0] * a * bottom[1]) * a)
        filtered = Discrete(A, np.eye(2), C, D, slow_camera.sensing.step)
        changed = replace(slow_camera, system=series(slow_camera.system, filtered))
        return close_loop(slow_camera.pose, changed).radius

    for _ in range(100):
        assert radius(0.99 * alpha, draw.uniform(-0.95, 0.95, 2), draw.choice([-1.0, 1.0], 2)) < 1.0
    side = sensitivities(slow_camera.pose, slow_camera)[0]
    omega = disk_margin(side).frequency
    T = side.transfer_function(np.array([omega]))[0] - 0.5 * np.eye(len(side.D))
    phases = np.zeros(len(T))
    for _ in range(40):  # ascent on the largest eigenvalue over unitary diagonals: a lower bound of mu
        values, vectors = np.linalg.eig(np.diag(np.exp(1j * phases)) @ T)
        top = int(np.argmax(np.abs(values)))
        left = np.linalg.inv(vectors)[top]
        phases = phases - np.angle(left * vectors[:, top])
    assert alpha <= 1.0001 / np.abs(values[top])
    assert alpha > 0.95 / np.abs(values[top])


def test_the_margin_of_a_slow_task_sensor_is_near_that_of_its_mean_delay(slow_camera: SampledController) -> None:
    """(every - 1)/2 samples rounded up are a little more than the mean: the exact one is larger, by a few percent."""
    other = replace(slow_camera.sensing, task_every=1, task_delay=slow_camera.sensing.task_delay + 2)
    late = SampledController("late", slow_camera.pose, other, slow_camera.system)
    exact, mean = (disk_margin(sensitivities(one.pose, one)[0]).alpha for one in (slow_camera, late))
    assert mean < exact < 1.1 * mean
