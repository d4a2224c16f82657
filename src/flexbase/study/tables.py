"""Results as CSV tables on disk."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

from flexbase.errors import InputError


def write_rows(path: str | Path, header: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table, numbers with all their digits. Raises InputError where the place cannot be written."""
    try:
        with open(path, "w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(header)
            table.writerows(rows)
    except OSError as fault:
        raise InputError(f"{path}: cannot be written ({fault.strerror}). Give a file in an existing folder.") from fault
