"""Rest under gravity: the sag of the base, and the stiffness that gravity adds."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.forces import gravity_forces
from flexbase.dynamics.kinematics import forward
from flexbase.errors import InputError
from flexbase.model.mounted import MountedArm

COMPLEX_STEP = 1e-30  # no difference is taken, so the derivative is exact to rounding


def gravity_torques(arm: MountedArm, q: Array) -> Array:
    """g(q), shape (N,)."""
    return np.array(gravity_forces(forward(arm.mechanism, tuple(q)), tuple(arm.gravity.tolist())))


def gravity_stiffness(arm: MountedArm, q: Array) -> Array:
    """dg/dq, shape (N, N), by a complex step."""
    if not arm.has_gravity:
        return np.zeros((arm.N, arm.N))
    columns = []
    for joint in range(arm.N):
        moved = q.astype(complex)
        moved[joint] += 1j * COMPLEX_STEP
        forces = gravity_forces(forward(arm.mechanism, tuple(moved)), tuple(arm.gravity.tolist()))
        columns.append(np.imag(np.array(forces, dtype=complex)) / COMPLEX_STEP)
    slope = np.array(columns).T
    return np.asarray(0.5 * (slope + slope.T))


def static_base(arm: MountedArm, arm_joints: Array, equilibrium: Array) -> Array:
    """Base joints at rest under gravity while the arm holds: Kp (qbar_p - q_p) = g_p(q). Raises InputError."""
    sag = equilibrium.copy()
    if not arm.has_gravity or arm.m == 0:
        return sag
    for _ in range(50):
        q = arm.parts.whole(sag, arm_joints)
        residual = arm.base.stiffness @ (sag - equilibrium) + arm.parts.base(gravity_torques(arm, q))
        slope = arm.base.stiffness + arm.parts.blocks(gravity_stiffness(arm, q)).passive
        if np.linalg.eigvalsh(slope)[0] <= 0.0:
            break
        step = np.linalg.solve(slope, -residual)
        sag = sag + step
        if np.abs(step).max() <= 1e-14 * (1.0 + np.abs(sag).max()):
            return np.asarray(sag)
    raise InputError(
        f"{arm.name}: the base does not hold the arm against gravity at joints {np.round(arm_joints, 4).tolist()}. "
        "Give a stiffer base, a lighter arm or another pose."
    )
