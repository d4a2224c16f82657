"""Tips of a path, from a CSV file."""

from __future__ import annotations

import csv
from pathlib import Path

from flexbase.cli.options.values import number
from flexbase.errors import InputError


def tips_of(path: Path) -> list[list[float]]:
    """Tips of a CSV file, one a line; a first line of names is passed over. Raises InputError."""
    try:
        lines = [row for row in csv.reader(path.read_text("utf-8-sig").splitlines()) if row]
    except (OSError, UnicodeDecodeError) as fault:
        raise InputError(f"--path: {path} cannot be read as text. Give a file with one tip a line.") from fault
    first = 1 if lines and not lines[0][0].strip().lstrip("+-.").replace(".", "").isdigit() else 0
    tips = [[number(word, f"--path, line {i}") for word in row] for i, row in enumerate(lines[first:], first + 1)]
    if not tips:
        raise InputError(f"--path: {path} holds no tips. Give one a line, such as 0.33,-0.25.")
    return tips
