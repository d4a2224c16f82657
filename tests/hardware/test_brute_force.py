"""The spectral radius against the loop run in time, sample by sample: rates, delays and holds done by hand."""

from __future__ import annotations

from collections import deque
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

import flexbase as fb
from flexbase.model.sensing import Sensing
from flexbase.sampled.closed import close_loop
from flexbase.sampled.controller import pd_with_gain

CASES = {
    "typical": Sensing(rate=4000.0),
    "slower task sensor": Sensing(rate=4000.0, task_every=4),
    "late task sensor": Sensing(rate=4000.0, task_every=3, task_delay=2, compute_delay=2),
    "no delay": Sensing(rate=4000.0, task_every=2, task_delay=0, compute_delay=0),
    "encoders": Sensing(rate=4000.0, task_every=2, acceleration="encoders"),
    "slow": Sensing(rate=1000.0, task_every=2),
}


def growth(pose: fb.Pose, sensing: Sensing, gains: fb.Gains, E: np.ndarray, samples: int = 6000) -> float:
    """Growth a sample of the linear arm under the law, written without any of flexbase's discrete systems."""
    N, n, m, k, h = pose.arm.N, pose.arm.n, pose.arm.m, pose.arm.k, sensing.step
    lag = sensing.accelerometer_lag
    inverse = np.linalg.inv(pose.M)
    A, B = np.zeros((2 * N + n, 2 * N + n)), np.zeros((2 * N + n, n))
    A[:N, N : 2 * N] = np.eye(N)
    A[N : 2 * N, : 2 * N] = np.hstack([-inverse @ pose.K, -inverse @ pose.D])
    B[N : 2 * N] = inverse[:, m:]
    A[2 * N :, : 2 * N], A[2 * N :, 2 * N :] = A[N + m : 2 * N, : 2 * N] / lag, -np.eye(n) / lag
    B[2 * N :] = B[N + m : 2 * N] / lag
    grown = scipy.linalg.expm(np.block([[A * h, B * h], [np.zeros((n, 2 * N + 2 * n))]]))
    Phi, Gamma = grown[: 2 * N + n, : 2 * N + n], grown[: 2 * N + n, 2 * N + n :]

    x = np.random.default_rng(0).normal(size=2 * N + n) * np.repeat([1e-4, 1e-2, 1.0], [N, N, n])
    tips = deque([np.zeros(k)] * (sensing.task_delay + 1), maxlen=sensing.task_delay + 1)
    torques = deque([np.zeros(n)] * (sensing.compute_delay + 1), maxlen=sensing.compute_delay + 1)
    held, before, q1, q2, filtered = np.zeros(k), np.zeros(k), np.zeros(n), np.zeros(n), np.zeros(n)
    share = 1.0 - np.exp(-2.0 * np.pi * sensing.acceleration_filter * h)
    scale, half = 0.0, 0.0
    for sample in range(samples):
        tips.append(pose.J @ x[:N])
        if sample % sensing.task_every == 0:  # a value is delivered, `task_delay` samples old
            before, held = held, tips[0]
        q = x[m:N]
        filtered = filtered + share * ((q - 2.0 * q1 + q2) / h**2 - filtered)
        q1, q2 = q, q1
        a = x[2 * N :] if sensing.acceleration == "accelerometer" else filtered
        f = -gains.stiffness @ held - gains.damping @ (held - before) / (sensing.task_every * h)
        torques.append(pose.J[:, m:].T @ f + E @ a)
        x = Phi @ x + Gamma @ torques[0]
        size = float(np.abs(x).max())
        if size > 1e100 or size < 1e-100:
            factor = 1.0 / size
            x, held, before, q1, q2, filtered = (part * factor for part in (x, held, before, q1, q2, filtered))
            tips = deque((part * factor for part in tips), maxlen=tips.maxlen)
            torques = deque((part * factor for part in torques), maxlen=torques.maxlen)
            scale += np.log(size)
            size = 1.0
        if sample == samples // 2:
            half = scale + np.log(np.linalg.norm(x))
    return float(np.exp((scale + np.log(np.linalg.norm(x)) - half) / (samples - 1 - samples // 2)))


@pytest.mark.parametrize("case", CASES)
def test_growth_in_time_is_the_spectral_radius(case: str, paper_pose: fb.Pose) -> None:
    """To 5e-4: what a turning mode's phase leaves after 3000 samples."""
    sensing = CASES[case]
    gains = fb.Gains(2e4 * np.eye(2), 500.0 * np.eye(2))
    E = fb.design(paper_pose, natural_frequency=346.8).E
    radius = close_loop(paper_pose, pd_with_gain(paper_pose, sensing, gains, E, "")).radius
    assert growth(paper_pose, sensing, gains, E) == pytest.approx(radius, abs=5e-4)
    other = close_loop(paper_pose, pd_with_gain(paper_pose, replace(sensing, task_every=1), gains, E, "")).radius
    if sensing.task_every > 1:
        assert abs(other - radius) > 1e-6  # the slower sensor is felt
