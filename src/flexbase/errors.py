"""What can go wrong, as types: the input is wrong, the answer is no, or a package is missing.

A message names the thing, its value, the bound and the mend, in one or two lines.
"""

from __future__ import annotations

import difflib
import importlib
import json
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from pkgutil import iter_modules
from types import ModuleType
from typing import Any


class FlexbaseError(Exception):
    """Root of all errors that flexbase raises on purpose."""


class InputError(FlexbaseError):
    """Something that the user gave is wrong: a file, a field, a value, a pose."""


class Unreachable(InputError):
    """No arm configuration brings the tip to the asked target."""


class SingularArm(InputError):
    """The arm Jacobian has lost rank at this pose, so task forces do not determine the motion."""


class Infeasible(FlexbaseError):
    """The question was understood and the answer is no: no such design exists."""


class Unsolvable(Infeasible):
    """An equation that the answer rests on has no solution: a singular matrix, no stabilising feedback."""


class MissingExtra(FlexbaseError):
    """An optional package is not installed; the message names the extra that brings it."""


class FlexbaseWarning(UserWarning):
    """Accepted, but the user should know."""


def import_extra(module: str, extra: str) -> ModuleType:
    """Import an optional package, or say which extra of flexbase brings it."""
    try:
        return importlib.import_module(module)
    except ImportError as missing:
        message = f'{module} is not installed. Install it with: pip install "flexbase[{extra}]"'
        raise MissingExtra(message) from missing


def import_all(package: ModuleType) -> None:
    """Import every module of a package, so that what they register is known."""
    for module in iter_modules(package.__path__):
        importlib.import_module(f"{package.__name__}.{module.name}")


@contextmanager
def writing(path: str | Path) -> Iterator[None]:
    """Within, a place that cannot be written is an InputError that names it."""
    try:
        yield
    except OSError as fault:
        why = fault.strerror or fault
        raise InputError(f"{path}: cannot be written ({why}). Give a file in an existing folder.") from fault


def read_document(path: str | Path, kind: str, form: str, mend: str) -> dict[str, Any]:
    """A JSON document whose "format" is `form`; kind : what it holds. Raises InputError, ending in `mend`."""
    try:
        document = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as fault:
        raise InputError(f"{path}: cannot be read ({fault.strerror}). {mend}") from fault
    except json.JSONDecodeError as fault:
        raise InputError(f"{path}: not valid JSON, line {fault.lineno}, column {fault.colno}. {mend}") from fault
    except (ValueError, RecursionError) as fault:
        raise InputError(f"{path}: not a JSON text. {mend}") from fault
    if not isinstance(document, dict) or document.get("format") != form:
        raise InputError(f"{path}: not a {kind}. {mend}")
    return document


def nearest_name(name: str, valid: Iterable[str]) -> str:
    """Return ' Did you mean "..."?' for the valid name closest to a wrong one, and the list otherwise."""
    names = [str(candidate) for candidate in valid]
    close = difflib.get_close_matches(str(name), names, n=1, cutoff=0.6)
    if close:
        return f'Did you mean "{close[0]}"?'
    return "Valid: " + ", ".join(names) + "." if names else "None is valid here."
