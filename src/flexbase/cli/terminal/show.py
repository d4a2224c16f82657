"""A result on the command line: written where `--out` says, then as one JSON document or as its sheet."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.out import write_out, written
from flexbase.cli.terminal.screen import put
from flexbase.sheets.sheet import Sheet
from flexbase.sheets.told import Told


def show(command: str, found: Told, json: bool, out: Path | None = None) -> None:
    """Write what `--out` asks for; then the result as one JSON document, or as its sheet."""
    content = found.to_dict()
    write_out(out, command, found, content)
    say(command, content, found.sheet(), json, out)


def say(command: str, content: Mapping[str, Any], sheet: Sheet, json: bool, out: Path | None = None) -> None:
    """A document or a sheet, and which file was written."""
    put(document(command, content)) if json else put(sheet, *written(out))
