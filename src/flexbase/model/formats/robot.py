"""Robot files: URDF or MJCF -> a chain of frozen arrays. Nothing foreign comes out, neither objects nor exceptions."""

from __future__ import annotations

from pathlib import Path

from flexbase.errors import FlexbaseError, InputError
from flexbase.model.formats.chain import RobotFile
from flexbase.model.formats.guard import parse, read_bytes, shown
from flexbase.model.formats.mjcf_tree import read_mjcf
from flexbase.model.formats.urdf_tree import read_urdf

READERS = {"robot": read_urdf, "mujoco": read_mjcf}


def read_robot_file(path: Path, tool: str | None, *, folder: Path) -> RobotFile:
    """Read the chain from the root of a URDF or MJCF file to a tool frame.

    Assumes nothing about the file: it may be hostile. Limits are in `guard`, `urdf.MOST_LINKS`, `chain.MOST_JOINTS`.

    path : the file, relative to `folder` or absolute, inside it
    tool : name of a link (URDF), or of a body or site (MJCF); None where only one frame can be meant
    Raises InputError in a line or two, which repeats nothing of the file but names of links and joints, cut to a few
    characters; MissingExtra without the packages of the extra "robots".
    """
    name = shown(path.name or str(path))[1:-1]
    try:
        return _read(read_bytes(path, folder), tool)
    except InputError as fault:
        raise InputError(f"{name}: {fault}") from fault
    except FlexbaseError:
        raise
    except Exception as fault:  # whatever a parser can throw: a traceback is never the user's
        raise InputError(f"{name}: cannot be understood as a robot ({type(fault).__name__}).") from fault


def _read(content: bytes, tool: str | None) -> RobotFile:
    root = parse(content)
    if root.tag not in READERS:
        raise InputError("neither URDF (<robot>) nor MJCF (<mujoco>). Convert it to one of them.")
    return READERS[root.tag](root, tool)
