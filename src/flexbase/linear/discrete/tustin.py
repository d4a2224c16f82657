"""The bilinear map between sampled and continuous systems, which keeps every norm over frequency."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array, inverse
from flexbase.linear.discrete.system import Discrete
from flexbase.linear.second_order import StateSpace

ROOT = np.sqrt(2.0)
HALF_WAY = "loop: a pole at exactly half the sampling rate has no continuous image. Give another rate."


def to_continuous(system: Discrete) -> StateSpace:
    """The system in w = (z - 1)/(z + 1), time counted in half samples: |z| = 1 becomes the imaginary axis.

    Raises Unsolvable for a pole at z = -1.
    """
    inverted = inverse(system.A + np.eye(system.order), HALF_WAY)
    B = inverted @ system.B
    return StateSpace(
        inverted @ (system.A - np.eye(system.order)), ROOT * B, ROOT * system.C @ inverted, system.D - system.C @ B
    )


def to_discrete(system: StateSpace, step: float) -> Discrete:
    """The way back, at any sampling interval. Raises Unsolvable for a pole at w = 1."""
    order = len(system.A)
    inverted = inverse(np.eye(order) - system.A, HALF_WAY)
    B = inverted @ system.B
    return Discrete(
        np.asarray(inverted @ (np.eye(order) + system.A)),
        ROOT * B,
        ROOT * system.C @ inverted,
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
