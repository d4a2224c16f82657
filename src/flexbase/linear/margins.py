"""Can a compensator be built? The algebraic loop through E, and the lag that the loop bears.  [theory §8]"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq, minimize

from flexbase.checks import Array
from flexbase.linear.closed_loop import abscissa, close_loop, lagged_abscissa
from flexbase.linear.linearise import has_arm_friction, has_arm_stiffness, linearise, modified_inertia
from flexbase.model.task import Gains
from flexbase.plant import Pose

LAGS = np.geomspace(1e-7, 1.0, 141)  # [s]; a loop that bears a second of lag is reported without a margin
PHASE_STARTS = 256


def loop_matrix(pose: Pose, E: Array) -> Array:
    """Ms^-1 E: the gain once around the algebraic loop q'' -> torque -> q''."""
    return np.asarray(np.linalg.solve(pose.Ms, E), dtype=float)


def algebraic_loop_radius(pose: Pose, E: Array) -> float:
    """rho(Ms^-1 E): one common delay, however small, destabilises unless this is below 1."""
    return float(np.abs(np.linalg.eigvals(loop_matrix(pose, E))).max())


def algebraic_loop_radius_per_joint(pose: Pose, E: Array) -> float:
    """mu = max over unitary diagonal Delta of rho(Ms^-1 E Delta): the same with another delay in each joint.

    Found by many starts and gradient steps over the phases of Delta: a lower bound that equals mu to about 1e-6.
    """
    A = loop_matrix(pose, E)
    n = len(A)
    if n == 1 or not A.any():
        return float(np.abs(np.linalg.eigvals(A)).max())
    phases = np.random.default_rng(0).uniform(-np.pi, np.pi, (PHASE_STARTS, n))
    phases[0], phases[:, 0] = 0.0, 0.0  # a phase common to all joints changes nothing
    radii = np.abs(np.linalg.eigvals(A * np.exp(1j * phases)[:, None, :])).max(axis=1)
    best = float(radii.max())
    for start in phases[np.argsort(-radii)[:4]]:
        found = minimize(lambda free: _negative_radius(A, free), start[1:], jac=True, method="BFGS")
        best = max(best, -float(found.fun))
    return best


def _negative_radius(A: Array, free: Array) -> tuple[float, Array]:
    """-rho(A Delta) and its derivative with respect to the phases after the first."""
    values, right = np.linalg.eig(A * np.exp(1j * np.concatenate([[0.0], free])))
    left = np.linalg.inv(right)
    top = int(np.argmax(np.abs(values)))
    radius = float(np.abs(values[top]))
    return -radius, radius * np.imag(left[top] * right[:, top])[1:]


def closed_loop_abscissa(pose: Pose, E: Array, gains: Gains) -> float:
    """Rightmost pole of the task-space PD loop with ideal acceleration feedback [1/s].

    The null-space motions of a redundant arm, which the task does not control, are left out.
    """
    system = replace(linearise(pose), M=modified_inertia(pose, E))  # an indefinite M - E shows as an unstable loop
    return abscissa(close_loop(system, gains), _drifting(pose))


def lag_margin(pose: Pose, E: Array, gains: Gains) -> float | None:
    """Smallest first-order lag in the acceleration feedback that destabilises the PD loop [s].

    0 if the loop is unstable without lag; None if no lag up to 1 s destabilises it. Null-space motions are left out.
    """
    if closed_loop_abscissa(pose, E, gains) >= 0.0:
        return 0.0
    if not E.any():
        return None
    loop, lagged, drifting = close_loop(linearise(pose), gains), pose.M - modified_inertia(pose, E), _drifting(pose)
    before = 0.0
    for lag in LAGS:
        if lagged_abscissa(loop, lagged, lag, drifting) >= 0.0:
            if before == 0.0:
                return 0.0
            return float(brentq(lambda T: lagged_abscissa(loop, lagged, T, drifting), before, lag, rtol=1e-9))
        before = lag
    return None


def _drifting(pose: Pose) -> int:
    """Poles at 0 of the motions of a redundant arm that neither the task nor gravity holds."""
    free = 0 if has_arm_stiffness(pose) else pose.arm.n - pose.arm.k
    return free if has_arm_friction(pose) else 2 * free
