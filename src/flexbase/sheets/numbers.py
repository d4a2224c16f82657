"""Numbers, lists of them and matrices, as people read them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any


def number(value: float | None, digits: int = 9) -> str:
    """A number to so many significant digits; undefined where there is none."""
    return "undefined" if value is None else f"{value + 0.0:.{digits}g}"


def kilo(value: float) -> str:
    """In thousands, to two digits or the whole number: 0.24, 8.6, 105."""
    return f"{1e-3 * value:.0f}" if abs(value) >= 1e4 else f"{1e-3 * value:.2g}"


def listed(values: Iterable[float], names: Iterable[str] = (), units: Iterable[str] = ()) -> str:
    """`q1 0.5 rad, q2 1 rad`."""
    entries = [number(value, 7) for value in values]
    named = [f"{name} {entry}" for name, entry in zip(names, entries, strict=True)] if names else entries
    return ", ".join(f"{entry} {unit}" for entry, unit in zip(named, units, strict=True)) if units else ", ".join(named)


def matrix(rows: Any) -> str:
    """A matrix with its entries under one another, or a row for a vector."""
    table_of_rows = [list(row) if hasattr(row, "__len__") else [row] for row in rows]
    if table_of_rows and all(len(row) == 1 for row in table_of_rows) and not hasattr(rows[0], "__len__"):
        table_of_rows = [[row[0] for row in table_of_rows]]
    digits = 9 if len(table_of_rows[0] if table_of_rows else ()) <= 4 else 3  # wide ones within 80 columns
    shown = [[number(float(entry), digits) for entry in row] for row in table_of_rows]
    width = max((len(entry) for row in shown for entry in row), default=0)
    return "\n".join("  ".join(entry.rjust(width) for entry in row) for row in shown)
