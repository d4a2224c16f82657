"""The nonlinear plant by our own dynamics: accelerations from torques, compensator included.  [U03 eq 1, 11]"""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import Frames
from flexbase.dynamics.motion import equation_of_motion, under_gain
from flexbase.model.mounted import MountedArm
from flexbase.plant import Pose
from flexbase.trace.algebra import Matrix, stack, unstack


def accelerations(pose: Pose, frames: Frames, q: Array, rates: Array, torque: Array, E: Array | None) -> Array:
    """q'' of (M - blkdiag(0, E)) q'' = [tau_p; tau~] - h - g, shape (..., N).

    The compensator's E q_a'' is part of the equation, not a measured signal: it is met exactly.

    q, rates : shape (..., N), with `frames` placed at q; torque : tau~, without the compensator's share, shape (..., n)
    pose : where the base springs rest
    Assumes M - E positive definite; see `keeps_inertia`.
    """
    arm = pose.arm
    M, force = equation_of_motion(
        arm, frames, unstack(q, 1), unstack(rates, 1), unstack(torque, 1), pose.equilibrium.tolist()
    )
    return solved(arm, M, stack(force), E)


def solved(arm: MountedArm, M: Matrix, force: Array, E: Array | None) -> Array:
    """q'' of (M - blkdiag(0, E)) q'' = force, shape (..., N); NaN where a trial step meets a singular M - E."""
    whole = stack(under_gain(arm, M, None if E is None else E.tolist()))
    try:
        return np.asarray(np.linalg.solve(whole, force[..., None])[..., 0])
    except np.linalg.LinAlgError:
        regular = np.linalg.slogdet(whole).sign != 0.0
        return np.asarray(np.linalg.solve(np.where(regular[..., None, None], whole, np.nan), force[..., None])[..., 0])


def keeps_inertia(arm: MountedArm, frames: Frames, E: Array | None) -> bool:
    """Whether M - E is positive definite there."""
    if E is None:
        return True
    whole = stack(under_gain(arm, mass_matrix(frames), E.tolist()))
    return float(np.linalg.eigvalsh(whole)[..., 0].min()) > 0.0
