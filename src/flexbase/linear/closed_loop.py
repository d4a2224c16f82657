"""The task-space PD loop closed around the linear model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexbase.checks import Array
from flexbase.linear.second_order import SecondOrder
from flexbase.model.task import Gains


def close_loop(system: SecondOrder, gains: Gains) -> SecondOrder:
    """The system under f = -(stiffness y + damping y'), still second order."""
    return replace(
        system,
        D=system.D + system.B @ gains.damping @ system.C,
        K=system.K + system.B @ gains.stiffness @ system.C,
    )


def abscissa(system: SecondOrder, drifting: int = 0) -> float:
    """Real part of the rightmost pole [1/s]; negative when the system settles.

    drifting : poles at 0, of motions that nothing controls, that are left out
    """
    return _rightmost(system.state_space().A, drifting)


def lagged_abscissa(system: SecondOrder, lagged: Array, lag: float, drifting: int = 0) -> float:
    """Rightmost pole of M q'' + D q' + K q = z, lag z' + z = L q'', for lag > 0 [s].

    lagged : L, shape (N, N): what a first-order lag delays. At lag = 0 the inertia would be M - L.
    """
    N = len(system.M)
    zero, eye = np.zeros((N, N)), np.eye(N)
    acceleration = np.linalg.solve(system.M, np.hstack([-system.K, -system.D, eye]))
    A = np.vstack(
        [
            np.hstack([zero, eye, zero]),
            acceleration,
            (lagged @ acceleration - np.hstack([zero, zero, eye])) / lag,
        ]
    )
    return _rightmost(A, drifting)


def _rightmost(A: Array, left_out: int) -> float:
    """Largest real part of the eigenvalues, without the `left_out` ones nearest to 0."""
    values = np.linalg.eigvals(A)
    return float(values[np.argsort(np.abs(values))[left_out:]].real.max())
