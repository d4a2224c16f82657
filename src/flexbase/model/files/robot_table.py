"""[robot]: planar links or a robot file, with payload, joint friction and rotor inertia -> a mechanism."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from flexbase.cautions import caution
from flexbase.checks import Array, check_length
from flexbase.errors import InputError
from flexbase.model.files.planar import planar
from flexbase.model.files.schema import RobotTable
from flexbase.model.formats.chain import NOTHING, Foot
from flexbase.model.formats.robot import read_robot_file
from flexbase.model.mechanism import Body, Mechanism, with_payload


def mechanism_of(table: RobotTable, base_joints: int, source: str, folder: Path | None) -> tuple[Mechanism, Foot]:
    """The robot's chain, the first `base_joints` of it passive; and what it stands on in its file.

    folder : where the project file lies; robot files are read from there and below, nowhere else
    Raises InputError, MissingExtra.
    """
    if (table.links is None) == (table.file is None):
        raise InputError(f"{source}, [robot]: give either [[robot.links]] or a file, one of them.")
    if table.links is not None:
        if table.tool is not None:
            raise InputError(f"{source}, [robot] tool: planar links end in their tool. Remove the key.")
        if table.file_friction:
            raise InputError(f"{source}, [robot] file_friction: there is no robot file. Give friction instead.")
        mechanism, foot = planar(table.links, source), Foot(NOTHING)
    else:
        mechanism, foot = _from_file(table, source, folder, base_joints)
    if table.payload is not None:
        where = f"{source}, [robot.payload] "
        payload = Body(
            table.payload.mass,
            check_length(f"{where}com", table.payload.com, 3, "x y z"),
            inertia_matrix(f"{where}inertia", table.payload.inertia),
        )
        mechanism = with_payload(mechanism, payload)
    n = max(mechanism.N - base_joints, 0)
    mechanism = replace(
        mechanism,
        friction=_for_the_arm(f"{source}, [robot] friction", table.friction, n, mechanism.friction),
        armature=_for_the_arm(f"{source}, [robot] rotor_inertia", table.rotor_inertia, n, mechanism.armature),
    )
    return mechanism, foot


def _for_the_arm(name: str, given: list[float] | None, n: int, otherwise: Array) -> Array:
    """Values for the last n joints before what stands there already for the base; all of that if none are given."""
    if given is None:
        return otherwise
    values = check_length(name, given, n, "one for each arm joint")
    if (values < 0.0).any():
        raise InputError(f"{name}: {values.min():g} is negative. Give zero or more.")
    return np.concatenate([otherwise[: len(otherwise) - n], values])


def inertia_matrix(name: str, numbers: list[float]) -> Array:
    """3 or 6 numbers, xx yy zz (xy xz yz), as a positive semidefinite matrix. Raises InputError."""
    six = [*numbers, 0.0, 0.0, 0.0] if len(numbers) == 3 else numbers
    xx, yy, zz, xy, xz, yz = check_length(name, six, 6, "xx yy zz, or xx yy zz xy xz yz")
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    smallest = float(np.linalg.eigvalsh(inertia)[0])
    if smallest < -1e-12 * float(np.abs(inertia).max()):
        raise InputError(f"{name}: smallest eigenvalue {smallest:g} kg m^2 is negative. Give a real body's inertia.")
    return inertia


def _from_file(table: RobotTable, source: str, folder: Path | None, base_joints: int) -> tuple[Mechanism, Foot]:
    file = str(table.file)
    if folder is None:
        raise InputError(f"{source}, [robot] file: a project given as text has no folder. Save it as a file.")
    try:
        found = read_robot_file(Path(file), table.tool, folder=folder)
    except InputError as fault:
        bare = Path(source).name == file
        raise fault if bare else InputError(f"{source}, [robot] file: {fault}") from fault
    for note in (note for note in found.notes if not (table.file_friction and "file_friction" in note)):
        caution(f"{file}: {note}")
    if found.stiffness.any():
        stiff = [name for name, k in zip(found.mechanism.joint_names, found.stiffness, strict=True) if k]
        caution(f"{file}: its joint stiffness ({', '.join(stiff)}) is left out: only [base] stiffness counts.")
    friction = np.where(np.arange(found.mechanism.N) < base_joints, 0.0, found.friction * table.file_friction)
    foot = found.foot._replace(notes=tuple(f"{file}: {note}" for note in found.foot.notes))
    return replace(found.mechanism, armature=found.armature, friction=friction), foot
