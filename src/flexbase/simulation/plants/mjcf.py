"""A plant as MJCF, the robot description that MuJoCo reads: the same chain, springs, drives and tool.

What MJCF does not allow is said in another way that gives the same motion:

- a body without mass: its joint goes to the next body that has some (several joints in one body);
- a full stiffness or damping matrix, which no joint attribute can hold: a fixed tendon for each of its eigenvectors;
- an inertia with A + B < C, as links given in the plane have it: where a body only ever turns about one direction,
  nothing but the inertia about that direction counts, and a ball with the same takes its place;
- a body with mass and no inertia: 1e-15 kg m^2, the least that MuJoCo accepts and less than rounding.
"""

from __future__ import annotations

import re
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np
from scipy.spatial.transform import Rotation

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.model.mechanism import Mechanism
from flexbase.model.mounted import MountedArm
from flexbase.plant import Plant

LEAST = 1e-15  # kg and kg m^2: mjMINVAL, the least that MuJoCo accepts of a moving body
ROUNDING = 1e-12  # of the largest principal moment
TIME_STEP = 1e-4  # s: some 150 a period of the paper's base
UNWRITABLE = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # what XML cannot hold


def to_mjcf(plant: Plant) -> str:
    """The plant as MJCF text, for MuJoCo and whatever else reads it; exact to rounding.

    Joints, motors and their order are ours, base first; a motor's `ctrl` is the arm joint's torque [N m or N]. The base
    rests at its equilibrium, gravity is the plant's, the site "tool" is the tool frame. There is no geometry.
    Raises InputError where a body's inertia is none that MuJoCo accepts, or a name cannot be written in XML.
    """
    return mjcf_of(plant.arm)


def mjcf_of(arm: MountedArm) -> str:
    """The arm on its base as MJCF text; see `to_mjcf`."""
    _check_names(arm)
    root = Element("mujoco", model=arm.name)
    SubElement(root, "compiler", angle="radian")
    SubElement(root, "option", integrator="RK4", timestep=repr(TIME_STEP), gravity=_numbers(arm.gravity))
    _write_bodies(SubElement(root, "worldbody"), arm)
    _write_tendons(root, arm)
    drives = SubElement(root, "actuator")
    for name in arm.joint_names:
        SubElement(drives, "motor", name=name, joint=name)
    indent(root)
    return tostring(root, encoding="unicode") + "\n"


def _write_bodies(world: Element, arm: MountedArm) -> None:
    """The chain, one body in the other; massless bodies hand their joints on."""
    mechanism = arm.mechanism
    parent, rotation, position = world, np.eye(3), np.zeros(3)
    joints: list[tuple[int, Array, Array]] = []  # of the next body: number, axis and anchor in its frame
    turns: list[Array] = []  # revolute axes so far, in the body's frame
    for i in range(mechanism.N):
        R, p = mechanism.placement_rotation[i], mechanism.placement_position[i]
        rotation, position = rotation @ R, position + rotation @ p
        joints = [(number, R.T @ axis, R.T @ (anchor - p)) for number, axis, anchor in joints]
        joints.append((i, mechanism.axes[i], np.zeros(3)))
        turns = [R.T @ axis for axis in turns] + ([mechanism.axes[i]] if mechanism.links[i].revolute else [])
        if mechanism.mass[i] == 0.0 and not mechanism.inertia[i].any() and i < mechanism.N - 1:
            continue
        name = f"{mechanism.joint_names[i]} body"
        body = SubElement(parent, "body", {"name": name, **_place(rotation, position)})
        for number, axis, anchor in joints:
            place = {"axis": _numbers(axis), "pos": _numbers(anchor)}
            SubElement(body, "joint", {**_joint(arm, number), **place})
        SubElement(body, "inertial", _inertial(mechanism, i, turns))
        parent, rotation, position, joints = body, np.eye(3), np.zeros(3), []
    SubElement(parent, "site", {"name": "tool", **_place(mechanism.tool_rotation, mechanism.tool_position)})


def _joint(arm: MountedArm, number: int) -> dict[str, str]:
    """Name and type of a joint, rotor inertia and friction, and the spring and damper of a base joint."""
    kind = "hinge" if arm.mechanism.links[number].revolute else "slide"
    words = {"name": arm.mechanism.joint_names[number], "type": kind}
    for key, value in (("armature", arm.mechanism.armature[number]), ("damping", arm.mechanism.friction[number])):
        if value:
            words[key] = _numbers(value)
    if number in arm.parts.passive:
        place = arm.parts.passive.index(number)
        words["springref"] = _numbers(arm.base.equilibrium[place])  # where tendons rest, too
        for key, matrix in (("stiffness", arm.base.stiffness), ("damping", arm.base.damping)):
            if _is_diagonal(matrix):
                words[key] = _numbers(matrix[place, place])
    return words


def _write_tendons(root: Element, arm: MountedArm) -> None:
    """Full matrices as sums of s v v^T: tendons of length v.q, with spring or damper s, at rest where the base is."""
    tendons = Element("tendon")
    for key, matrix in (("stiffness", arm.base.stiffness), ("damping", arm.base.damping)):
        if _is_diagonal(matrix):
            continue
        strengths, shapes = np.linalg.eigh(matrix)
        for number, (strength, shape) in enumerate(zip(strengths, shapes.T, strict=True), start=1):
            if strength > 0.0:
                tendon = SubElement(tendons, "fixed", {"name": f"{key} {number}", key: _numbers(strength)})
                for name, share in zip(arm.parts.base(arm.mechanism.joint_names), shape, strict=True):
                    SubElement(tendon, "joint", joint=name, coef=_numbers(share))
    if len(tendons):
        root.append(tendons)


def _inertial(mechanism: Mechanism, i: int, turns: list[Array]) -> dict[str, str]:
    """Mass, centre of mass and principal moments that MuJoCo accepts. Raises InputError."""
    inertia = mechanism.inertia[i]
    moments, axes = _principal(inertia)
    if not _is_physical(moments) and all(np.abs(np.cross(turns[0], axis)).max() <= ROUNDING for axis in turns):
        about = float(turns[0] @ inertia @ turns[0]) if turns else 0.0
        moments, axes = np.full(3, about), np.eye(3)
    if not _is_physical(moments):
        raise InputError(
            f'to_mjcf: the body of joint "{mechanism.joint_names[i]}" has principal inertias '
            f"{np.sort(moments).tolist()} kg m^2; MuJoCo wants them positive, none above the sum of the others. "
            "Give the inertia of a real body."
        )
    moments = np.maximum(moments, LEAST)
    largest = int(np.argmax(moments))
    moments[largest] = min(moments[largest], np.delete(moments, largest).sum())  # A + B >= C to the last bit
    mass = max(float(mechanism.mass[i]), LEAST)
    return {"mass": _numbers(mass), **_place(axes, mechanism.com[i]), "diaginertia": _numbers(moments)}


def _principal(inertia: Array) -> tuple[Array, Array]:
    """Principal moments, and the rotation whose columns are their axes."""
    if _is_diagonal(inertia):
        return np.diag(inertia), np.eye(3)
    moments, axes = np.linalg.eigh(inertia)
    return moments, axes * np.linalg.det(axes)


def _is_physical(moments: Array) -> bool:
    """Whether some distribution of mass has these principal moments, to rounding."""
    slack = ROUNDING * float(np.abs(moments).max())
    return bool(moments.min() >= -slack and 2.0 * moments.max() <= moments.sum() + slack)


def _is_diagonal(matrix: Array) -> bool:
    return bool(np.array_equal(matrix, np.diag(np.diag(matrix))))


def _place(rotation: Array, position: Array) -> dict[str, str]:
    """Position and, unless there is none, rotation: MuJoCo's quaternions begin with the scalar."""
    words = {"pos": _numbers(position)}
    if not np.array_equal(rotation, np.eye(3)):
        words["quat"] = _numbers(np.roll(Rotation.from_matrix(rotation).as_quat(), 1))
    return words


def _numbers(values: Array | float) -> str:
    """The shortest text that reads back as the same doubles."""
    return " ".join(repr(float(value) + 0.0).removesuffix(".0") for value in np.ravel(values))


def _check_names(arm: MountedArm) -> None:
    for name in (arm.name, *arm.mechanism.joint_names):
        if UNWRITABLE.search(name):
            raise InputError(f"to_mjcf: the name {name!r} holds a character that XML cannot. Rename it.")
