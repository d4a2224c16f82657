"""Write figures and tables to files, the same bytes for the same content."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from flexbase.errors import InputError, writing
from flexbase.report.style import SCREEN_DPI, styled
from flexbase.sweeps.answers.tables import write_rows

METADATA: dict[str, dict[str, str | None]] = {
    ".png": {"Software": "flexbase"},
    ".svg": {"Date": None, "Creator": "flexbase"},
    ".pdf": {"CreationDate": None, "Creator": "flexbase", "Producer": None},
}


def check_picture_path(path: str | Path) -> Path:
    """A path with a suffix that can be drawn. Raises InputError."""
    place = Path(path)
    if place.suffix.lower() not in METADATA:
        given = f'suffix "{place.suffix}"' if place.suffix else "no suffix"
        raise InputError(f"{place}: {given}, but pictures are written as {', '.join(METADATA)}. Give one of these.")
    return place


def save_figure(figure: Figure, path: str | Path) -> None:
    """Write a figure as png, svg or pdf, by suffix. Raises InputError naming the suffix or the unwritable place."""
    place = check_picture_path(path)
    kind = place.suffix.lower()
    with writing(place), styled():
        figure.savefig(place, format=kind[1:], dpi=SCREEN_DPI, metadata=METADATA[kind])


def make_folder(path: str | Path) -> Path:
    """The folder, created with its parents if needed. Raises InputError."""
    place = Path(path)
    try:
        place.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise InputError(f"{place}: this folder cannot be made ({fault.strerror}). Give another one.") from fault
    return place


def save_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table; numbers with 9 significant digits, what is undefined as an empty field. Raises InputError."""
    write_rows(path, header, ([_field(value) for value in row] for row in rows))


def save_text(path: Path, text: str) -> None:
    """Write text. Raises InputError."""
    with writing(path):
        path.write_text(text, encoding="utf-8")


def _field(value: object) -> object:
    if value is None:
        return ""
    if isinstance(value, float | np.floating):
        return f"{value:.9g}" if np.isfinite(value) else ""
    return value
