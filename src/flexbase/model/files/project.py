"""Read a project file: TOML -> validated tables -> frozen arrays."""

from __future__ import annotations

import tomllib
from importlib import resources
from pathlib import Path

from pydantic import ValidationError

from flexbase.cautions import caution
from flexbase.checks import check_length
from flexbase.errors import InputError, nearest_name
from flexbase.model.files.base_table import InertiaAt, base_of
from flexbase.model.files.bundled import LIBRARY, robots
from flexbase.model.files.messages import first_fault
from flexbase.model.files.robot_table import mechanism_of
from flexbase.model.files.schema import BaseTable, ProjectFile, RobotTable, TaskTable
from flexbase.model.files.sensing_table import sensing_of
from flexbase.model.mounted import MountedArm
from flexbase.model.task import ROWS, Gains, Task, make_gains

LARGEST_FILE = 1_000_000  # bytes; a project file is a page
ROBOT_FILES = (".urdf", ".xml", ".mjcf")


def load_project(robot: str | Path, inertia_at: InertiaAt) -> MountedArm:
    """Load a bundled project by name, a project file, or a bare robot file (on a rigid base) by path.

    inertia_at : M at a configuration, for bases that are given by frequencies
    Raises InputError, MissingExtra.
    """
    if not isinstance(robot, str | Path):
        raise InputError(f"robot: {type(robot).__name__} given. Give a bundled name or a path.")
    if isinstance(robot, str) and robot in robots().descriptions:
        with resources.as_file(resources.files(LIBRARY)) as folder:
            return parse_project((folder / f"{robot}.toml").read_text("utf-8"), robot, inertia_at, folder)
    path = Path(robot)
    if not str(robot) or not _exists(path):
        hint = nearest_name(str(robot), robots().descriptions)
        raise InputError(f'"{str(robot)[:80]}": neither a bundled robot nor a file. {hint}')
    if not path.is_file():
        raise InputError(f"{robot}: is not a file. Give the path of a project file (.toml).")
    if path.suffix.lower() in ROBOT_FILES:
        return _bare(path)
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
    return parse_project(text, str(robot), inertia_at, path.parent)


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # a name that no file system accepts
        return False


def parse_project(
    text: str, source: str, inertia_at: InertiaAt | None = None, folder: Path | None = None
) -> MountedArm:
    """Turn the text of a project file into an arm on its base.

    source : names the file in messages; folder : where its robot file may lie
    inertia_at : M at a configuration, needed for bases that are given by frequencies
    Raises InputError, MissingExtra.
    """
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as fault:
        raise InputError(f"{source}: not valid TOML: {str(fault)[:200]}.") from fault
    except ValueError as fault:  # Python's own limit on the digits of an integer
        raise InputError(f"{source}: an integer with thousands of digits. Give numbers in SI units.") from fault
    except RecursionError as fault:
        raise InputError(f"{source}: lists or tables nested too deeply. A project file needs two levels.") from fault
    try:
        project = ProjectFile.model_validate(tables)
    except ValidationError as fault:
        raise InputError(f"{source}, {first_fault(fault)}") from fault
    return _build(project, source, inertia_at, folder)


def _build(project: ProjectFile, source: str, inertia_at: InertiaAt | None, folder: Path | None) -> MountedArm:
    table = project.base or BaseTable()
    mechanism, foot = mechanism_of(project.robot, len(table.joints), source, folder)
    mechanism, base = base_of(table, mechanism, foot, source, inertia_at)
    if base.m == 0:
        caution(f"{source}: no [base] joints: a rigid base, without modes.")
    task = _task(project, mechanism.N - base.m, source)
    gravity = check_length(f"{source}, gravity", project.gravity, 3, "x y z")
    sensing = sensing_of(project.sensing, mechanism.N - base.m, source)
    return MountedArm(project.name, mechanism, base, task, gravity, _gains(project, task, source), sensing)


def _bare(path: Path) -> MountedArm:
    """A robot file without a project: a rigid base, and as many task rows as the arm can move."""
    robot = RobotTable(file=path.name)
    arm, _ = mechanism_of(robot, 0, str(path), path.parent)
    rows = TaskTable.model_validate({"rows": list(ROWS[: min(arm.N, len(ROWS))])})
    return _build(ProjectFile(name=path.stem, robot=robot, task=rows), str(path), None, path.parent)


def _task(project: ProjectFile, n: int, source: str) -> Task:
    rows = project.task.rows
    if len(set(rows)) < len(rows):
        raise InputError(f"{source}, [task] rows: {rows} names a row twice. Name each once.")
    spatial = [row for row in rows if row not in ("x", "y", "rz")]
    if spatial and project.robot.links is not None and not (project.base and project.base.joint):
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
