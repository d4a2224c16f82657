"""Files that `--out` asks for, refused before any work is done where they could not be written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from flexbase.cli.terminal.document import document
from flexbase.errors import InputError, writing

PICTURES = (".png", ".svg", ".pdf")
OutFile = Annotated[Path | None, Parameter(name=["--out", "-o"], metavar="FILE")]
Out = Annotated[OutFile, Parameter(help="write a picture (.png .svg .pdf) or .json")]


def check_out(path: Path | None, suffixes: Sequence[str] = (*PICTURES, ".json")) -> None:
    """Raise InputError where a file has no home or a suffix that this command does not write."""
    if path is None:
        return
    if suffixes and path.suffix.lower() not in suffixes:
        raise InputError(f'--out: {path} ends in "{path.suffix}". Give a file that ends in {" or ".join(suffixes)}.')
    if path.is_dir():
        raise InputError(f"--out: {path} is a folder. Give a file in it.")
    if not path.parent.is_dir():
        raise InputError(f"--out: {path} has no home: {path.parent} is not a folder. Make it first.")


def write_out(path: Path | None, command: str, result: Any, content: Mapping[str, Any]) -> None:
    """Write a result as its suffix says: a picture, a table, NetCDF, or its JSON document. Raises InputError."""
    if path is None:
        return
    suffix = path.suffix.lower()
    if suffix == ".json":
        write_text(path, document(command, content) + "\n")
    elif suffix == ".csv":
        result.save_csv(path)
    elif suffix == ".nc":
        result.save_netcdf(path)
    else:
        from flexbase.report.plot import save_plot

        try:
            save_plot(result, path)
        except OSError as fault:
            raise InputError(f"--out: {path} cannot be written ({fault.strerror}).") from fault


def written(path: Path | None) -> list[str]:
    """The line that tells people what was written, or none."""
    return [] if path is None else ["", f"  Written: {path}"]


def write_text(path: Path, text: str) -> None:
    """Write a text file. Raises InputError."""
    with writing(path), path.open("w", encoding="utf-8", newline="\n") as file:
        file.write(text)
