"""Parameters of a plant that may be varied: springs, dampers and masses, as factors that may be symbols or batches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from flexbase.dynamics.kinematics import Frames
from flexbase.model.mounted import MountedArm
from flexbase.trace.algebra import Matrix, Scalar, Vector, matvec, mul, plus, scale, sqrt, sub


class Parameter(NamedTuple):
    """What may be varied: its unit, what it is, the value that leaves the plant as it is, and the least that it has."""

    unit: str
    purpose: str
    nominal: float
    least: float


SMALLEST = 1e-6  # of a factor that may not vanish
PARAMETERS = {
    "stiffness": Parameter("1", "factor on the base's stiffness matrix", 1.0, SMALLEST),
    "damping": Parameter("1", "factor on the base's damping matrix", 1.0, 0.0),
    "payload": Parameter("kg", "point mass added at the tool", 0.0, 0.0),
    "link_mass": Parameter("1", "factor on mass and inertia of every arm link", 1.0, SMALLEST),
    "link_com": Parameter("1", "factor on the distance of every arm link's centre of mass from its joint", 1.0, 0.0),
}
OF_BASE_JOINTS, OF_ARM_JOINTS = ("stiffness", "damping"), ("link_mass", "link_com")


def parameters_of(arm: MountedArm) -> dict[str, Parameter]:
    """All parameters of an arm: those of `PARAMETERS`, and the same of a single joint, such as `stiffness.q1`.

    A base joint's own factor f scales its row and column of the stiffness or damping matrix by sqrt(f), so that the
    matrix stays positive definite. Factors of all and of one multiply.
    """
    names = arm.mechanism.joint_names
    found = dict(PARAMETERS)
    for kinds, joints, whole in (
        (OF_BASE_JOINTS, arm.parts.base(names), "the base's {kind} at joint {joint} alone"),
        (OF_ARM_JOINTS, arm.parts.arm(names), "{kind} of the link behind joint {joint} alone"),
    ):
        for kind in kinds:
            for joint in joints:
                purpose = "factor on " + whole.format(kind=kind, joint=joint)
                found[f"{kind}.{joint}"] = PARAMETERS[kind]._replace(purpose=purpose)
    return found


def varied_frames(arm: MountedArm, frames: Frames, parameters: Mapping[str, Scalar]) -> Frames:
    """The arm's links with other masses, their centres of mass moved along their own distance, and the payload.

    parameters : names of `parameters_of` -> values; what is left out is nominal
    """
    links, coms = list(frames.links), list(frames.coms)
    for i in arm.parts.active:
        heavier, farther = (_factor(parameters, kind, arm.mechanism.joint_names[i]) for kind in OF_ARM_JOINTS)
        link = links[i]
        turned = tuple(tuple(scale(heavier, row)) for row in link.inertia)
        links[i] = link._replace(mass=mul(heavier, link.mass), inertia=turned)
        if type(farther) is not float or farther != 1.0:
            coms[i] = plus(coms[i], scale(sub(farther, 1.0), matvec(frames.rotations[i], link.com)))
    return replace(frames, links=tuple(links), coms=tuple(coms), payload=parameters.get("payload", 0.0))


def varied_base(arm: MountedArm, kind: str, parameters: Mapping[str, Scalar]) -> Matrix:
    """The base's "stiffness" or "damping" matrix under parameters, m x m."""
    matrix: Matrix = {"stiffness": arm.base.stiffness, "damping": arm.base.damping}[kind].tolist()
    names = arm.parts.base(arm.mechanism.joint_names)
    whole = parameters.get(kind, 1.0)
    own: Vector = [parameters.get(f"{kind}.{name}", 1.0) for name in names]
    return tuple(
        tuple(
            mul(whole, mul(own[i] if i == j else sqrt(mul(own[i], own[j])), entry)) if entry != 0.0 else 0.0
            for j, entry in enumerate(row)
        )
        for i, row in enumerate(matrix)
    )


def _factor(parameters: Mapping[str, Scalar], kind: str, joint: str) -> Scalar:
    return mul(parameters.get(kind, 1.0), parameters.get(f"{kind}.{joint}", 1.0))
