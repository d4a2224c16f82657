"""Tip targets of a job, with names: from numbers or from a table on disk."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from flexbase.checks import FARTHEST, Array, check_within, finite_array
from flexbase.errors import InputError, nearest_name
from flexbase.model.task import Task

MOST = 200
NAME = "name"


@dataclass(frozen=True, eq=False)
class Targets:
    """Where the tip has to go: values of shape (T, k) [m, rad] and a name for each."""

    values: Array
    names: tuple[str, ...]


def make_targets(task: Task, targets: ArrayLike | Targets) -> Targets:
    """Targets from rows of numbers, one value for each task row; numbered from 1. Raises InputError."""
    if isinstance(targets, Targets):
        return _checked(task, targets.values, targets.names)
    values = np.atleast_2d(finite_array("targets", targets))
    return _checked(task, values, tuple(str(i + 1) for i in range(len(values))))


def read_targets(task: Task, path: str | Path) -> Targets:
    """Targets from a CSV file: a column for each task row, such as x,y,z, and if wanted one called `name`.

    Raises InputError naming the file, the line and the column.
    """
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            table = csv.DictReader(file, skipinitialspace=True)
            columns = [column.strip() for column in table.fieldnames or ()]
            table.fieldnames = columns
            lines = list(table)
    except OSError as fault:
        raise InputError(f"{path}: cannot be read ({fault.strerror}). Give a CSV file of targets.") from fault
    except (UnicodeDecodeError, csv.Error) as fault:
        raise InputError(f"{path}: is no table in UTF-8 ({fault}). Give a CSV file of targets.") from fault
    for row in task.rows:
        if row not in columns:
            raise InputError(f'{path}: no column "{row}". The first line has to name {", ".join(task.rows)}.')
    for column in columns:
        if column not in (*task.rows, NAME):
            raise InputError(f'{path}: column "{column}" is unknown. {nearest_name(column, (*task.rows, NAME))}')
    if not lines:
        raise InputError(f"{path}: holds no target. Give a line for each.")
    values = [[_number(path, i + 2, row, line[row]) for row in task.rows] for i, line in enumerate(lines)]
    names = tuple((line.get(NAME) or "").strip() or str(i + 1) for i, line in enumerate(lines))
    return _checked(task, np.array(values), names)


def _number(path: str | Path, line: int, column: str, text: str | None) -> float:
    try:
        return float(text or "")
    except ValueError:
        raise InputError(f'{path}, line {line}: {column} "{text or ""}" is not a number. Give one.') from None


def _checked(task: Task, values: Array, names: tuple[str, ...]) -> Targets:
    if values.ndim != 2 or values.shape[1] != task.k:
        raise InputError(f"targets: shape {values.shape} given, one value for each of {' '.join(task.rows)} needed.")
    if not 1 <= len(values) <= MOST:
        raise InputError(f"targets: {len(values)} given, but 1 to {MOST} are placed. Give fewer.")
    check_within("targets", finite_array("targets", values), FARTHEST, "rad or m")
    return Targets(values, names)
