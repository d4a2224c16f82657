"""How much a sampled loop's torques tremble because its sensors do."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.linear.discrete.system import feedback
from flexbase.plant import Pose
from flexbase.sampled.controller import SampledController
from flexbase.sampled.plant import sampled_plant

TIP_NOISE = 1e-5  # m or rad, where the sensing declares none
COUNTS = 2.0**18  # a turn (or metre), where the sensing declares none
DOUBLINGS = 40  # 2^40 samples: long after any loop that counts as stable has forgotten
ACCELERATION_NOISE = 0.5  # rad/s^2 or m/s^2, where the sensing declares none


def sensor_noise(controller: SampledController) -> Array:
    """Standard deviations of tip error (k), joints (n) and accelerations (n); declared, or typical ones."""
    sensing, n, k = controller.sensing, controller.pose.arm.n, controller.pose.arm.k
    prismatic = np.array([unit == "m" for unit in controller.pose.arm.joint_units])
    quantum = np.where(prismatic, 1.0, 2.0 * np.pi) / (sensing.encoder_counts or COUNTS)
    return np.concatenate(
        [
            np.full(k, sensing.task_noise or TIP_NOISE),
            quantum / np.sqrt(12.0),
            np.full(n, sensing.acceleration_noise or ACCELERATION_NOISE),
        ]
    )


def torque_noise(pose: Pose, controller: SampledController) -> Array:
    """Standard deviation of every arm torque under white sensor noise, shape (n,) [N m or N]. Assumes a stable loop.

    The quantisation of encoders counts as white, of variance q^2/12.
    """
    n, k = pose.arm.n, pose.arm.k
    plant = sampled_plant(pose, controller.sensing).select(list(range(k + 2 * n)), list(range(n)))
    loop = feedback(controller.system, plant)  # noise is added to what the plant shows
    spread = np.diag(sensor_noise(controller) ** 2)
    covariance = _covariance(loop.A, loop.B @ spread @ loop.B.T)
    return np.asarray(np.sqrt(np.diag(loop.C @ covariance @ loop.C.T + loop.D @ spread @ loop.D.T)))


def _covariance(A: Array, Q: Array) -> Array:
    """X = A X A^T + Q of a stable A, by doubling: sums of positive terms keep digits that a transform loses."""
    X = Q
    for _ in range(DOUBLINGS):
        X, A = X + A @ X @ A.T, A @ A
    return np.asarray(X)
