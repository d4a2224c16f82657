"""[base]: the robot's first joints made passive, or joints added below it; stiffness, or frequencies -> a base."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.spatial.transform import Rotation

from flexbase.cautions import caution
from flexbase.checks import FARTHEST, Array, check_length, check_within
from flexbase.errors import InputError, nearest_name
from flexbase.model.base import Base, make_base
from flexbase.model.files.robot_table import inertia_matrix
from flexbase.model.files.schema import BaseTable
from flexbase.model.formats.chain import AT_ORIGIN, NOTHING, Foot, Place, welded
from flexbase.model.mechanism import Body, Mechanism
from flexbase.model.parts import base_first

MOST_JOINTS = 6
InertiaAt = Callable[[Mechanism, Array], Array]


def base_of(
    table: BaseTable, mechanism: Mechanism, foot: Foot, source: str, inertia_at: InertiaAt | None
) -> tuple[Mechanism, Base]:
    """The chain with the base's own joints put before it, and the base.

    foot : what the robot stands on in its file; it moves where joints are added below
    inertia_at : M at a configuration, for a base that is given by frequencies
    Raises InputError.
    """
    where = f"{source}, [base] "
    if table.joints and table.joint:
        raise InputError(f"{where}joints: the robot's own joints and added ones ([[base.joint]]) exclude each other.")
    if not table.joint and (table.body or table.mount):
        raise InputError(f"{where}body and mount belong to added joints. Add [[base.joint]], or remove them.")
    if table.joint:
        mechanism = _with_added_joints(table, mechanism, foot, source)
    names, m = list(mechanism.joint_names), len(table.joints) or len(table.joint)
    if table.joints:
        _check_first(table.joints, names, where)
    if m > MOST_JOINTS:
        raise InputError(f"{where}joints: {m} passive joints, at most {MOST_JOINTS} are supported.")
    for key in ("stiffness", "damping", "frequency", "equilibrium"):
        if not m and getattr(table, key):
            raise InputError(
                f"{where}{key}: there are no base joints. Remove the key, or name joints in [base] joints."
            )
    if m == len(names):
        raise InputError(f"{where}joints: all {m} joints are passive, so no arm is left. Add links.")
    equilibrium = check_length(f"{where}equilibrium", table.equilibrium or [0.0] * m, m, "one for each base joint")
    check_within(f"{where}equilibrium", equilibrium, FARTHEST, "rad or m")
    stiffness, damping = _springs(table, mechanism, equilibrium, where, inertia_at)
    return mechanism, make_base(stiffness, damping, equilibrium, m, where=where)


def _check_first(joints: list[str], names: list[str], where: str) -> None:
    unknown = [name for name in joints if name not in names]
    if unknown:
        raise InputError(f'{where}joints: no joint "{unknown[0]}". {nearest_name(unknown[0], names)}')
    if joints != names[: len(joints)]:
        raise InputError(
            f"{where}joints: {joints} are not the first of the chain {names}. Base joints come first, in chain order."
        )


def _with_added_joints(table: BaseTable, arm: Mechanism, foot: Foot, source: str) -> Mechanism:
    added = len(table.joint)
    names = (*(joint.name for joint in table.joint), *arm.joint_names)
    for name in names:
        if names.count(name) > 1:
            raise InputError(f'{source}, [[base.joint]] name: "{name}" is given twice. Rename one.')
    for note in foot.notes:
        caution(note)
    mount = _mount(table, source)
    body = welded(_body(table, source), mount.carry(foot.body))
    placement_rotation, placement_position = arm.placement_rotation.copy(), arm.placement_position.copy()
    placement_position[0] = mount.position + mount.rotation @ placement_position[0]
    placement_rotation[0] = mount.rotation @ placement_rotation[0]
    bodies = [NOTHING] * (added - 1) + [body]
    return Mechanism(
        joint_names=names,
        joint_types=(*(joint.type for joint in table.joint), *arm.joint_types),
        axes=np.vstack([*(_axis(joint.axis, i, source) for i, joint in enumerate(table.joint, 1)), arm.axes]),
        placement_rotation=np.concatenate([np.tile(np.eye(3), (added, 1, 1)), placement_rotation]),
        placement_position=np.concatenate([np.zeros((added, 3)), placement_position]),
        mass=np.concatenate([[one.mass for one in bodies], arm.mass]),
        com=np.concatenate([[one.com for one in bodies], arm.com]),
        inertia=np.concatenate([[one.inertia for one in bodies], arm.inertia]),
        tool_rotation=arm.tool_rotation,
        tool_position=arm.tool_position,
        armature=np.concatenate([np.zeros(added), arm.armature]),
        friction=np.concatenate([np.zeros(added), arm.friction]),
    )


def _axis(axis: list[float], number: int, source: str) -> Array:
    place = f"{source}, [[base.joint]] number {number}, axis"
    given = check_length(place, axis, 3, "x y z")
    length = float(np.linalg.norm(given))
    if length == 0.0:
        raise InputError(f"{place}: [0, 0, 0] has no direction. Give a nonzero direction.")
    return given / length


def _body(table: BaseTable, source: str) -> Body:
    if table.body is None:
        return NOTHING
    where = f"{source}, [base.body] "
    com = check_length(f"{where}com", table.body.com, 3, "x y z")
    return Body(table.body.mass, com, inertia_matrix(f"{where}inertia", table.body.inertia))


def _mount(table: BaseTable, source: str) -> Place:
    if table.mount is None:
        return AT_ORIGIN
    where = f"{source}, [base.mount] "
    rpy = check_length(f"{where}rpy", table.mount.rpy, 3, "roll pitch yaw")
    xyz = check_length(f"{where}xyz", table.mount.xyz, 3, "x y z")
    return Place(Rotation.from_euler("xyz", rpy).as_matrix(), xyz)


def _springs(
    table: BaseTable, mechanism: Mechanism, equilibrium: Array, where: str, inertia_at: InertiaAt | None
) -> tuple[Array | list[float], Array | list[float]]:
    """Stiffness and damping as given, or as each joint's own frequency and damping ratio ask for."""
    m = len(equilibrium)
    if (table.frequency is None) == (table.stiffness is None) and m:
        raise InputError(f"{where}stiffness: give either stiffness and damping, or frequency and damping_ratio.")
    if table.frequency is None:
        if table.damping_ratio is not None or table.reference is not None:
            raise InputError(f"{where}damping_ratio and reference go with frequency. Give damping instead.")
        if table.damping is None and m:
            raise InputError(f"{where}damping: is missing. Add it; zeros say that there is none.")
        return table.stiffness or [], table.damping or []
    if table.damping is not None:
        raise InputError(f"{where}damping: with frequency, give damping_ratio instead.")
    if inertia_at is None:
        raise InputError(f"{where}frequency: needs the dynamics. Load the project with flexbase.load.")
    n = mechanism.N - m
    omega = check_length(f"{where}frequency", table.frequency, m, "one for each base joint")
    zeta = check_length(f"{where}damping_ratio", table.damping_ratio or [0.0] * m, m, "one for each base joint")
    if (omega <= 0.0).any() or (zeta < 0.0).any():
        raise InputError(f"{where}frequency: frequencies must be above 0 and damping ratios 0 or more.")
    arm = check_length(f"{where}reference", table.reference or [0.0] * n, n, "one for each arm joint")
    check_within(f"{where}reference", arm, FARTHEST, "rad or m")
    parts = base_first(m, mechanism.N)
    inertia = parts.base(np.diag(inertia_at(mechanism, parts.whole(equilibrium, arm))))
    stiffness, damping = omega**2 * inertia, 2.0 * zeta * omega * inertia
    caution(
        f"{where}frequency: taken as stiffness {np.round(stiffness, 6).tolist()} and damping "
        f"{np.round(damping, 6).tolist()}, each joint alone with the arm locked at {arm.tolist()}.",
    )
    return stiffness, damping
