"""Independent witnesses of the delay law: eigenvalues with a late acceleration, and the law by Pinocchio's matrices."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from flexbase.plant import Pose
from systems.oracle import FullSystem


def law(pose: Pose, E: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """omega^2, psi^T Dp psi and phi_a^T E phi_a of the undamped modes, slowest first."""
    m, system = pose.arm.m, FullSystem(pose, E)
    follow = np.linalg.solve(system.M[m:, m:], system.M[m:, :m])
    S = system.M[:m, :m] - system.M[:m, m:] @ follow
    squares, shapes = scipy.linalg.eigh(pose.arm.base.stiffness, 0.5 * (S + S.T))
    phi_a = -follow @ shapes
    damping = np.diag(shapes.T @ pose.arm.base.damping @ shapes)
    return squares, damping, np.diag(phi_a.T @ E @ phi_a)


def dampings(pose: Pose, E: np.ndarray, lag: float, kind: str = "lag") -> np.ndarray:
    """-2 Re of the vibration poles without a task loop, in the order of the poles without lag.

    kind : "lag", first order; "delay", (1 - s T/2)/(1 + s T/2), the first Pade fraction: -1 + 2/(1 + s T/2)
    """
    before = FullSystem(pose, E).vibrations()
    if lag == 0.0:
        return -2.0 * before.real
    if kind == "lag":
        poles = FullSystem(pose, E).lagged_poles(lag)
    else:
        system = FullSystem(pose, 2.0 * E)
        system.inertia = system.inertia + 0.5 * system.E
        poles = system.lagged_poles(0.5 * lag)
    return np.array([-2.0 * poles[np.argmin(np.abs(poles - pole))].real for pole in before])
