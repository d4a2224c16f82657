"""A fingerprint of an arm: what kernels and stores are filed under."""

from __future__ import annotations

import hashlib

import numpy as np

from flexbase.model.mounted import MountedArm


def model_digest(arm: MountedArm) -> str:
    """A fingerprint of every number of an arm on its base that a sweep reads."""
    digest = hashlib.sha256()
    mechanism = arm.mechanism
    digest.update(repr((mechanism.joint_names, mechanism.joint_types, arm.task)).encode())
    arrays = [value for value in vars(mechanism).values() if isinstance(value, np.ndarray)]
    arrays += [arm.base.stiffness, arm.base.damping, arm.base.equilibrium]
    arrays += [] if arm.gains is None else [arm.gains.stiffness, arm.gains.damping]
    for array in arrays:
        digest.update(repr(array.shape).encode() + np.ascontiguousarray(array, dtype=float).tobytes())
    return digest.hexdigest()
