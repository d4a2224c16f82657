"""Read a project file: TOML -> validated tables -> frozen arrays."""

from __future__ import annotations

import tomllib
import warnings
from importlib import resources
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from flexbase.checks import Array, check_length
from flexbase.errors import FlexbaseWarning, InputError, nearest_name
from flexbase.model.base import Base, make_base
from flexbase.model.files.messages import first_fault
from flexbase.model.files.schema import BaseTable, LinkTable, PayloadTable, ProjectFile
from flexbase.model.mechanism import Body, Mechanism, with_payload
from flexbase.model.mounted import MountedArm
from flexbase.model.task import Gains, Task, make_gains

LARGEST_FILE = 1_000_000  # bytes; a project file is a page


def bundled() -> dict[str, str]:
    """Names of the bundled projects, each with its one-line description (the first comment of its file)."""
    found = {}
    for entry in sorted(resources.files("flexbase.model.library").iterdir(), key=lambda item: item.name):
        if entry.name.endswith(".toml"):
            first_line = entry.read_text("utf-8").partition("\n")[0]
            found[entry.name.removesuffix(".toml")] = first_line.lstrip("# ").strip()
    return found


def load_project(robot: str | Path) -> MountedArm:
    """Load a bundled project by name, or a project file by path. Raises InputError."""
    if isinstance(robot, str) and robot in (names := bundled()):
        text = (resources.files("flexbase.model.library") / f"{robot}.toml").read_text("utf-8")
        return parse_project(text, robot)
    path = Path(robot)
    if not str(robot) or not _exists(path):
        names = bundled()
        hint = nearest_name(str(robot), names)
        raise InputError(f'"{str(robot)[:80]}": neither a bundled robot nor a file. {hint}')
    if not path.is_file():
        raise InputError(f"{robot}: is not a file. Give the path of a project file (.toml).")
    try:
        raw = path.read_bytes() if path.stat().st_size <= LARGEST_FILE else None
    except OSError as fault:
        raise InputError(f"{robot}: cannot be read ({fault.strerror}).") from fault
    if raw is None:
        raise InputError(f"{robot}: larger than {LARGEST_FILE} bytes, which no project file is.")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise InputError(f"{robot}: not UTF-8 text (byte {fault.start}). A project file is TOML.") from fault
    return parse_project(text, str(robot))


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # a name that no file system accepts
        return False


def parse_project(text: str, source: str) -> MountedArm:
    """Turn the text of a project file into an arm on its base; `source` names it in messages. Raises InputError."""
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as fault:
        raise InputError(f"{source}: not valid TOML: {str(fault)[:200]}.") from fault
    try:
        return _build(ProjectFile.model_validate(tables), source)
    except ValidationError as fault:
        raise InputError(f"{source}, {first_fault(fault)}") from fault


def _build(project: ProjectFile, source: str) -> MountedArm:
    mechanism = _planar(project.robot.links, source)
    if project.robot.payload is not None:
        mechanism = with_payload(mechanism, _payload(project.robot.payload, source))
    base = _base(project.base, mechanism, source)
    if base.m == 0:
        warnings.warn(f"{source}: no [base] joints: a rigid base, without modes.", FlexbaseWarning, stacklevel=2)
    task = _task(project, mechanism.N - base.m, source)
    gravity = check_length(f"{source}, gravity", project.gravity, 3, "x y z")
    return MountedArm(project.name, mechanism, base, task, gravity, _gains(project, task, source))


def _planar(links: list[LinkTable], source: str) -> Mechanism:
    """Planar links: z out of the plane, each link along its own x axis."""
    names = [link.joint for link in links]
    repeated = sorted({name for name in names if names.count(name) > 1})
    if repeated:
        raise InputError(f'{source}, [[robot.links]] joint: the name "{repeated[0]}" is given twice. Rename one.')
    axes = np.array([_axis(link, number, source) for number, link in enumerate(links, start=1)])
    lengths = [link.length for link in links]
    return Mechanism(
        joint_names=tuple(names),
        joint_types=tuple(link.type for link in links),
        axes=axes,
        placement_rotation=np.tile(np.eye(3), (len(links), 1, 1)),
        placement_position=_along_x([0.0, *lengths[:-1]]),
        mass=np.array([link.mass for link in links]),
        com=_along_x([link.com for link in links]),
        inertia=np.array([np.diag([0.0, 0.0, link.inertia]) for link in links]),
        tool_rotation=np.eye(3),
        tool_position=_along_x([lengths[-1]])[0],
    )


def _axis(link: LinkTable, number: int, source: str) -> Array:
    if link.type == "revolute":
        if "axis" in link.model_fields_set:
            raise InputError(
                f"{source}, [[robot.links]] number {number}, axis: planar revolute joints turn about z. Remove the key."
            )
        return np.array([0.0, 0.0, 1.0])
    place = f"{source}, [[robot.links]] number {number}, axis:"
    axis = np.array(link.axis, dtype=float)
    if axis.shape != (2,):
        raise InputError(f"{place} {link.axis} given, 2 numbers needed: x and y.")
    length = float(np.hypot(*axis))
    if length == 0.0:
        raise InputError(f"{place} [0, 0] has no direction. Give a nonzero direction.")
    return np.array([axis[0] / length, axis[1] / length, 0.0])


def _along_x(distances: list[float]) -> Array:
    return np.array([[distance, 0.0, 0.0] for distance in distances])


def _payload(table: PayloadTable, source: str) -> Body:
    com = check_length(f"{source}, [robot.payload] com", table.com, 3, "x y z")
    six = [*table.inertia, 0.0, 0.0, 0.0] if len(table.inertia) == 3 else table.inertia
    xx, yy, zz, xy, xz, yz = check_length(
        f"{source}, [robot.payload] inertia", six, 6, "xx yy zz, or xx yy zz xy xz yz"
    )
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    smallest = float(np.linalg.eigvalsh(inertia)[0])
    if smallest < -1e-12 * float(np.abs(inertia).max()):
        raise InputError(f"{source}, [robot.payload] inertia: smallest eigenvalue {smallest:g} kg m^2 is negative.")
    return Body(table.mass, com, inertia)


def _base(table: BaseTable | None, mechanism: Mechanism, source: str) -> Base:
    table = table or BaseTable.model_construct(joints=[], stiffness=[], damping=[], equilibrium=None)
    m, names = len(table.joints), list(mechanism.joint_names)
    unknown = [name for name in table.joints if name not in names]
    if unknown:
        raise InputError(f'{source}, [base] joints: no joint "{unknown[0]}". {nearest_name(unknown[0], names)}')
    if table.joints != names[:m]:
        raise InputError(
            f"{source}, [base] joints: {table.joints} are not the first of the chain {names}. "
            "Base joints come first, in chain order."
        )
    if m == len(names):
        raise InputError(f"{source}, [base] joints: all {m} joints are passive, so no arm is left. Add links.")
    equilibrium = [0.0] * m if table.equilibrium is None else table.equilibrium
    return make_base(table.stiffness, table.damping, equilibrium, m, where=f"{source}, [base] ")


def _task(project: ProjectFile, n: int, source: str) -> Task:
    rows = project.task.rows
    if len(set(rows)) < len(rows):
        raise InputError(f"{source}, [task] rows: {rows} names a row twice. Name each once.")
    spatial = [row for row in rows if row not in ("x", "y", "rz")]
    if spatial:
        raise InputError(f'{source}, [task] rows: planar links never move "{spatial[0]}". Valid: x, y, rz.')
    if len(rows) > n:
        raise InputError(
            f"{source}, [task] rows: {len(rows)} rows but only {n} arm joint{'s' * (n > 1)}. Give at most {n} rows."
        )
    return Task(tuple(rows), project.task.branch)


def _gains(project: ProjectFile, task: Task, source: str) -> Gains | None:
    control = project.control
    if control is None:
        return None
    return make_gains(control.stiffness, control.damping, task.k, where=f"{source}, [control] ")
