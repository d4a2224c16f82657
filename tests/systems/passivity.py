"""Positive realness and implementability by brute force, from the full state-space matrices alone."""

from __future__ import annotations

import numpy as np

from flexbase.plant import Pose
from systems.oracle import FullSystem


def loop_radius(pose: Pose, E: np.ndarray) -> float:
    """rho(Ms^-1 E): Ms^-1 is the arm's block of the inverse of the whole inertia."""
    around = np.linalg.inv(FullSystem(pose).inertia)[pose.arm.m :, pose.arm.m :] @ E
    return float(np.abs(np.linalg.eigvals(around)).max())


def least_eigenvalue(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, B: np.ndarray, C: np.ndarray, damping: np.ndarray | None = None
) -> float:
    """Least eigenvalue of the Hermitian part of s C (M s^2 + D s + K)^-1 B over omega, relative to its largest.

    A dense sweep: four decades, and 121 points about every vibration. Negative beyond rounding: not positive real.
    """
    N = len(M)
    A = np.block([[np.zeros((N, N)), np.eye(N)], [-np.linalg.solve(M, np.hstack([K, D]))]])
    poles = np.linalg.eigvals(A)
    poles = poles[(poles.imag >= 0.0) & (np.abs(poles) > 1e-4 * np.abs(poles).max())]
    around = np.concatenate([-np.geomspace(30.0, 0.01, 60), [0.0], np.geomspace(0.01, 30.0, 60)])
    omega = np.concatenate([abs(pole) + around * abs(pole.real) for pole in poles])
    size = np.abs(poles)
    omega = np.concatenate([omega[omega > 0.02 * size.min()], np.geomspace(0.02 * size.min(), 50.0 * size.max(), 500)])
    s = 1j * omega[:, None, None]
    G = s * (C @ np.linalg.solve(M * s * s + D * s + K, np.broadcast_to(B + 0j, (len(omega), *B.shape))))
    eigenvalues = np.linalg.eigvalsh(0.5 * (G + np.conj(np.swapaxes(G, 1, 2))))
    return float(eigenvalues.min() / np.abs(eigenvalues).max())


def passivity(pose: Pose, E: np.ndarray) -> float:
    """`least_eigenvalue` of the task's own port, f to y'."""
    system = FullSystem(pose, E)
    return least_eigenvalue(system.M, system.D, system.K, system.B, system.C)
