"""Parameters of the plant that a sweep may vary beside the configuration."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import forward, task_jacobian
from flexbase.measures import Configuration
from flexbase.model.mounted import MountedArm
from flexbase.trace.algebra import Matrix, Scalar, Vector, mul, scale


class Parameter(NamedTuple):
    """What may be varied: its unit, what it is, and the value that leaves the plant as it is."""

    unit: str
    purpose: str
    nominal: float


PARAMETERS = {
    "stiffness": Parameter("1", "factor on the base's stiffness matrix", 1.0),
    "damping": Parameter("1", "factor on the base's damping matrix", 1.0),
    "payload": Parameter("kg", "point mass added at the tool", 0.0),
    "link_mass": Parameter("1", "factor on mass and inertia of every arm link", 1.0),
}


def configuration_of(
    arm: MountedArm, joints: Vector, parameters: Mapping[str, Scalar], E: Matrix | None
) -> Configuration:
    """What measures read, of arm joints (n scalars) with the base at rest, under parameters that differ from nominal.

    Leaves out gravity's stiffness and sag, and joint friction.
    """
    frames = forward(arm.mechanism, (*arm.base.equilibrium.tolist(), *joints))
    heavier = parameters.get("link_mass", 1.0)
    links = tuple(
        link._replace(mass=mul(heavier, link.mass), inertia=tuple(tuple(scale(heavier, row)) for row in link.inertia))
        if i >= arm.m
        else link
        for i, link in enumerate(frames.links)
    )
    frames = replace(frames, links=links)
    return Configuration(
        M=mass_matrix(frames, parameters.get("payload", 0.0)),
        J=task_jacobian(frames, arm.task.indices),
        m=arm.m,
        stiffness=tuple(scale(parameters.get("stiffness", 1.0), row) for row in arm.base.stiffness.tolist()),
        damping=tuple(scale(parameters.get("damping", 1.0), row) for row in arm.base.damping.tolist()),
        E=E,
        gains=arm.gains,
    )
