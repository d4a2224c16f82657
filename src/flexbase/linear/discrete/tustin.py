"""The bilinear map between sampled and continuous systems, which keeps every norm over frequency."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.linear.discrete.system import Discrete
from flexbase.linear.second_order import StateSpace

ROOT = np.sqrt(2.0)


def to_continuous(system: Discrete) -> StateSpace:
    """The system in w = (z - 1)/(z + 1), time counted in half samples: |z| = 1 becomes the imaginary axis.

    Assumes no pole at z = -1 (raises numpy.linalg.LinAlgError).
    """
    inverse = np.linalg.inv(system.A + np.eye(system.order))
    B = inverse @ system.B
    return StateSpace(
        inverse @ (system.A - np.eye(system.order)), ROOT * B, ROOT * system.C @ inverse, system.D - system.C @ B
    )


def to_discrete(system: StateSpace, step: float) -> Discrete:
    """The way back, at any sampling interval. Assumes no pole at w = 1."""
    order = len(system.A)
    inverse = np.linalg.inv(np.eye(order) - system.A)
    B = inverse @ system.B
    return Discrete(
        np.asarray(inverse @ (np.eye(order) + system.A)),
        ROOT * B,
        ROOT * system.C @ inverse,
        np.asarray(system.D + system.C @ B),
        step,
    )


def balanced_truncation(system: Discrete, order: int) -> tuple[Discrete, Array]:
    """The states that matter most for a stable system, and all its Hankel singular values, largest first.

    The error over all frequencies is at most twice the sum of the values left out.
    """
    from scipy.linalg import solve_discrete_lyapunov

    reach = _root(solve_discrete_lyapunov(system.A, system.B @ system.B.T))
    watch = _root(solve_discrete_lyapunov(system.A.T, system.C.T @ system.C))
    left, values, right = np.linalg.svd(watch.T @ reach)
    scale = 1.0 / np.sqrt(values[:order])
    into = scale[:, None] * (left[:, :order].T @ watch.T)
    out = reach @ right[:order].T * scale
    return Discrete(into @ system.A @ out, into @ system.B, system.C @ out, system.D, system.step), values


def _root(gramian: Array) -> Array:
    """Q with Q Q^T = gramian, of a semidefinite matrix."""
    values, vectors = np.linalg.eigh(0.5 * (gramian + gramian.T))
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))
