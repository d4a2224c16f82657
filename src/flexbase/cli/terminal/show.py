"""Tables, facts and matrices for people; as wide as the terminal, in colour only there."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

from rich import box
from rich.console import Console, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from flexbase.cli.terminal import screen
from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.out import write_out, written
from flexbase.sheets.numbers import matrix
from flexbase.sheets.plain import plain
from flexbase.sheets.sheet import Sheet, together
from flexbase.sheets.told import Told

GOOD, BAD, QUIET, HEAD = "green", "red", "dim", "bold"


def show(command: str, found: Told, json: bool, out: Path | None = None, **also: Any) -> None:
    """Write what `--out` asks for; then a result as one JSON document, or as its sheet.

    also : further keys of the document; the sheets of results among them stand below
    """
    sheet = together(found.sheet(), *_sheets(also.values()))
    say(command, {**found.to_dict(), **plain(also)}, sheet, json, out, found)


def say(
    command: str, content: Mapping[str, Any], sheet: Sheet, json: bool, out: Path | None = None, drawn: Any = None
) -> None:
    """The same of a document and a sheet; `drawn` is what a picture shows."""
    write_out(out, command, drawn, content)
    screen.put(document(command, content)) if json else screen.put(sheet, *written(out))


def _sheets(values: Iterable[Any]) -> Iterator[Sheet]:
    for one in values:
        if isinstance(one, Told):
            yield one.sheet()
        elif isinstance(one, list | tuple):
            yield from _sheets(one)


class Screen(Console):
    """A console that lets a closed pipe through as an exception."""

    def on_broken_pipe(self) -> NoReturn:
        """Raise again what rich would turn into an exit."""
        raise


def put(*parts: RenderableType) -> None:
    """Print to stdout. Signs that its encoding lacks are replaced."""
    screen = Screen(file=sys.stdout, highlight=False, markup=False, emoji=False)
    with screen.capture() as captured:
        for part in parts:
            screen.print(part, soft_wrap=isinstance(part, str))
    encoding = sys.stdout.encoding or "utf-8"
    text = "\n".join(line.rstrip() for line in captured.get().split("\n"))
    sys.stdout.write(text.encode(encoding, "replace").decode(encoding))


def title(text: str, rest: str = "") -> Text:
    """A heading, and quiet words behind it."""
    return Text.assemble((text, HEAD), (f"  {rest}" if rest else "", QUIET))


def verdict(good: bool, yes: str, no: str, rest: str = "") -> RenderableType:
    """Yes in green or no in red, and the words that qualify it."""
    said = Text.assemble((yes if good else no, f"bold {GOOD if good else BAD}"), f". {rest}" if rest else "")
    return Padding(said, (0, 0, 0, 2))


def facts(rows: Iterable[tuple[str, object]]) -> RenderableType:
    """Names and what they are, one a line; a matrix stands in rows."""
    grid = Table.grid(padding=(0, 2))
    grid.add_column(style=QUIET, no_wrap=True)
    grid.add_column(overflow="fold")
    for name, value in rows:
        grid.add_row(name, value if isinstance(value, str | Text) else matrix(value))
    return Padding(grid, (0, 0, 0, 2))


def table(
    columns: Sequence[str],
    rows: Iterable[Sequence[str]],
    words: Sequence[int] = (0,),
    *,
    blank_after: bool = True,
    widest: int | None = None,
) -> RenderableType:
    """A table; the columns numbered in `words` are aligned left, the others hold numbers.

    widest : of the columns after the first, in characters
    """
    drawn = Table(box=box.SIMPLE_HEAD, header_style=HEAD, pad_edge=False, show_edge=False)
    for index, column in enumerate(columns):
        kind = {"justify": "left"} if index in words else {"justify": "right", "no_wrap": widest is None}
        drawn.add_column(column, overflow="fold", max_width=widest if index else None, **kind)
    for row in rows:
        drawn.add_row(*row)
    return Padding(drawn, (1, 0, 1 if blank_after else 0, 2))
