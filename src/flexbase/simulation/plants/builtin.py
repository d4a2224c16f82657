"""The nonlinear plant by our own dynamics: accelerations from torques, compensator included.  [U03 eq 1, 11]"""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.forces import bias_forces
from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import Frames
from flexbase.plant import Pose
from flexbase.trace.algebra import stack, unstack


def accelerations(pose: Pose, frames: Frames, q: Array, rates: Array, torque: Array, E: Array | None) -> Array:
    """q'' of (M - blkdiag(0, E)) q'' = [tau_p; tau~] - h - g, shape (..., N).

    The compensator's E q_a'' is part of the equation, not a measured signal: it is met exactly.

    q, rates : shape (..., N), with `frames` placed at q; torque : tau~, without the compensator's share, shape (..., n)
    pose : where the base springs rest
    Assumes M - E positive definite; see `keeps_inertia`.
    """
    arm = pose.arm
    base = arm.base
    M = inertia_under(frames, E)
    spring = (pose.equilibrium - q[..., : arm.m]) @ base.stiffness - rates[..., : arm.m] @ base.damping
    bias = stack(bias_forces(frames, unstack(rates, 1), arm.gravity.tolist()))
    force = np.concatenate([spring, torque], axis=-1) - bias - arm.mechanism.friction * rates
    return np.asarray(np.linalg.solve(M, force[..., None])[..., 0])


def inertia_under(frames: Frames, E: Array | None) -> Array:
    """M - blkdiag(0, E) at a configuration or a batch of them, shape (..., N, N)."""
    M = stack(mass_matrix(frames))
    if E is not None:
        n = len(E)
        M[..., -n:, -n:] -= E
    return M


def keeps_inertia(frames: Frames, E: Array | None) -> bool:
    """Whether M - E is positive definite there."""
    return E is None or float(np.linalg.eigvalsh(inertia_under(frames, E))[..., 0].min()) > 0.0
