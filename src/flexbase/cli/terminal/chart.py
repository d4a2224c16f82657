"""A map in numbers: its axes, its cells and the extent of its measures; and the files it is written to."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import RenderableType

from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.out import PICTURES, check_out, write_out
from flexbase.cli.terminal.show import facts, table, title
from flexbase.errors import InputError
from flexbase.sheets.numbers import number
from flexbase.sweeps import document as numbers
from flexbase.sweeps import save_csv, save_netcdf
from flexbase.sweeps.answers.summary import counts, extents, measures_of
from flexbase.sweeps.engine.status import statuses_of

if TYPE_CHECKING:
    import xarray

KINDS = (*PICTURES, ".html", ".csv", ".json", ".nc", ".zarr")


def tables(found: xarray.Dataset) -> list[RenderableType]:
    """Heading, axes and cells, and the smallest and largest value of each measure."""
    rows = []
    for one in extents(found):
        known = one.smallest == one.smallest
        extent = [number(one.smallest, 7), number(one.largest, 7)] if known else ["none", "none"]
        rows.append([one.measure, str(one.mode) if one.mode else "", *extent, one.unit])
    axes = [(f"axis {name}", _extent(found[name])) for name in reversed(found["status"].dims)]
    meanings = statuses_of(found)
    cells = [(meanings[code], f"{count} cells") for code, count in counts(found).items()]
    zeros = [(f"{name} = 0", zero) for name in measures_of(found) if (zero := found[name].attrs.get("zero_is"))]
    given = found.attrs
    judged, with_or_without = given.get("judged"), "with" if given["compensated"] else "without"
    state = f"of {judged}" if judged else f"{with_or_without} compensator"
    heading = f"map {given.get('difference', state)}"
    columns = ["measure", "mode", "smallest", "largest", "unit"]
    said = facts([*axes, *cells, *zeros])
    return [title(found.attrs["robot"], heading), "", said, table(columns, rows, words=(0, 4), blank_after=False)]


def _extent(axis: xarray.DataArray) -> str:
    unit = "" if axis.attrs["units"] == "1" else f" {axis.attrs['units']}"
    return f"{number(float(axis[0]), 6)} to {number(float(axis[-1]), 6)}{unit}, {axis.size} cells"


def check_map_out(out: Path | None, resume: bool) -> None:
    """Raise InputError where the file cannot be written, before any work; a store may be there already."""
    if out is not None and store_of(out):
        if out.exists() and not out.is_dir():
            raise InputError(f"--out: {out} is a file, a store is a folder. Give another name.")
        if not out.parent.is_dir():
            raise InputError(f"--out: {out} has no home: {out.parent} is not a folder. Make it first.")
        return
    check_out(out, KINDS)
    if resume:
        raise InputError("--resume: only a store can be resumed. Give --out NAME.zarr.")


def store_of(out: Path | None) -> Path | None:
    """Where blocks are kept as they finish."""
    return out if out is not None and out.suffix.lower() == ".zarr" else None


def write_map(out: Path | None, found: xarray.Dataset) -> None:
    """Write a map as its suffix says; a store is written already. Raises InputError."""
    suffix = "" if out is None else out.suffix.lower()
    if suffix == ".csv":
        save_csv(found, str(out))
    elif suffix == ".nc":
        save_netcdf(found, str(out))
    elif suffix == ".json" and out is not None:
        out.write_text(document("map", numbers(found)) + "\n", "utf-8")
    elif suffix not in ("", ".zarr"):
        write_out(out, "map", found, {})
