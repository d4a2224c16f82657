"""A map on the command line: the files that it is written to, then its document or its sheet."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.out import PICTURES, check_out, write_out, written
from flexbase.cli.terminal.screen import put
from flexbase.errors import InputError
from flexbase.sweeps import document as numbers
from flexbase.sweeps import save_csv, save_netcdf
from flexbase.sweeps.answers.summary import sheet_of

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


def show_map(command: str, found: xarray.Dataset, json: bool, out: Path | None) -> None:
    """Write what `--out` asks for, as its suffix says; then all cells as one document, or the sheet. Raises InputError.

    A store is written already.
    """
    suffix = "" if out is None else out.suffix.lower()
    if suffix == ".csv":
        save_csv(found, str(out))
    elif suffix == ".nc":
        save_netcdf(found, str(out))
    elif suffix != ".zarr":
        write_out(out, command, found, numbers(found) if suffix == ".json" else {})
    put(document(command, numbers(found))) if json else put(sheet_of(found), *written(out))
