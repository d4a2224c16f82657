"""The files that a map is written to."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.out import PICTURES, check_out, write_out
from flexbase.errors import InputError
from flexbase.sweeps import document as numbers
from flexbase.sweeps import save_csv, save_netcdf

if TYPE_CHECKING:
    import xarray

KINDS = (*PICTURES, ".html", ".csv", ".json", ".nc", ".zarr")


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
