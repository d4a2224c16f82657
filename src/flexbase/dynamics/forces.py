"""Inverse dynamics by the recursive Newton-Euler algorithm, and its parts, on any number type.  [F08 ch 5]"""

from __future__ import annotations

from flexbase.dynamics.kinematics import Frames
from flexbase.dynamics.spatial import (
    ZERO_MOTION,
    ZERO_VECTOR,
    Force,
    Motion,
    force_cross,
    momentum,
    motion_cross,
    power,
    scaled,
    sum_of_forces,
    sum_of_motions,
)
from flexbase.trace.algebra import Scalar, Vector, add, mul, scale


def inverse_dynamics(frames: Frames, velocity: Vector, acceleration: Vector, gravity: Vector = ZERO_VECTOR) -> Vector:
    """Joint forces M q'' + h(q, q') + g(q) that produce an acceleration, without friction.  [U03 eq 1]"""
    v, a = ZERO_MOTION, Motion(ZERO_VECTOR, scale(-1.0, gravity))
    wrenches: list[Force] = []
    for motion, body, rate, change in zip(frames.motions, frames.bodies, velocity, acceleration, strict=True):
        joint = scaled(rate, motion)
        v = sum_of_motions(v, joint)
        a = sum_of_motions(sum_of_motions(a, scaled(change, motion)), motion_cross(v, joint))
        wrenches.append(sum_of_forces(momentum(body, a), force_cross(v, momentum(body, v))))
    torques: list[Scalar] = [0.0] * len(wrenches)
    carried = None
    for i in reversed(range(len(wrenches))):
        carried = wrenches[i] if carried is None else sum_of_forces(wrenches[i], carried)
        torques[i] = add(power(carried, frames.motions[i]), mul(frames.links[i].armature, acceleration[i]))
    return tuple(torques)


def bias_forces(frames: Frames, velocity: Vector, gravity: Vector = ZERO_VECTOR) -> Vector:
    """h(q, q') + g(q): centrifugal, Coriolis and gravity forces."""
    return inverse_dynamics(frames, velocity, (0.0,) * len(frames.motions), gravity)


def gravity_forces(frames: Frames, gravity: Vector) -> Vector:
    """g(q): what the joints must hold at rest."""
    rest = (0.0,) * len(frames.motions)
    return inverse_dynamics(frames, rest, rest, gravity)
