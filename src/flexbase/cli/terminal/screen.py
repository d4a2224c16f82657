"""A sheet on a terminal: as wide as it is, in colour only there."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import NoReturn

from rich import box
from rich.console import Console, RenderableType
from rich.padding import Padding
from rich.table import Table as Grid
from rich.text import Text

from flexbase.sheets.sheet import BAD, GOOD, Answer, Facts, Note, Part, Sheet, Table
from flexbase.sheets.text import printable

QUIET, HEAD = "dim", "bold"
COLOURS = {GOOD: "bold green", BAD: "bold red"}


class Screen(Console):
    """A console that lets a closed pipe through as an exception."""

    def on_broken_pipe(self) -> NoReturn:
        """Raise again what rich would turn into an exit."""
        raise


def put(*said: Sheet | str) -> None:
    """Print sheets and lines to stdout. Signs that its encoding lacks are replaced."""
    screen = Screen(file=sys.stdout, highlight=False, markup=False, emoji=False)
    with screen.capture() as captured:
        for one in said:
            for part in _sheet(one) if isinstance(one, Sheet) else (one,):
                screen.print(part, soft_wrap=isinstance(part, str))
    encoding = sys.stdout.encoding or "utf-8"
    text = "\n".join(line.rstrip() for line in captured.get().split("\n"))
    sys.stdout.write(text.encode(encoding, "replace").decode(encoding))


def _sheet(sheet: Sheet) -> Iterator[RenderableType]:
    """Its parts with a blank line between them; cautions go to stderr, where the program says them."""
    rest = printable(f"  {sheet.rest}") if sheet.rest else ""
    yield Text.assemble((printable(sheet.title), HEAD), (rest, QUIET))
    for part in sheet.parts:
        yield ""
        yield from _part(part)


def _part(part: Part) -> Iterator[RenderableType]:
    match part:
        case Sheet():
            yield from _sheet(part)
        case Facts():
            yield from _heading(part.heading)
            yield _indented(_facts(part))
        case Table():
            yield from _heading(part.heading)
            yield _indented(_table(part))
        case Answer():
            rest = printable(f". {part.rest}") if part.rest else ""
            yield _indented(Text.assemble((printable(part.sentence), COLOURS.get(part.tone, HEAD)), rest))
        case Note():
            yield _indented(Text(printable(part.text)))


def _heading(words: str) -> Iterator[RenderableType]:
    if words:
        yield _indented(Text(printable(f"{words}:")))


def _facts(found: Facts) -> Grid:
    grid = Grid.grid(padding=(0, 2))
    grid.add_column(style=QUIET, no_wrap=True)
    grid.add_column(overflow="fold")
    for name, value in found.rows:
        grid.add_row(Text(printable(name)), Text(printable(value)))
    return grid


def _table(found: Table) -> Grid:
    drawn = Grid(box=box.SIMPLE_HEAD, header_style=HEAD, pad_edge=False, show_edge=False)
    folds = any(column.widest for column in found.columns)
    for one in found.columns:
        side = {"justify": "left"} if one.words else {"justify": "right", "no_wrap": not folds}
        drawn.add_column(Text(printable(one.head)), overflow="fold", max_width=one.widest, **side)
    for row in found.rows:
        drawn.add_row(*(Text(printable(cell)) for cell in row))
    return drawn


def _indented(part: RenderableType) -> Padding:
    return Padding(part, (0, 0, 0, 2))
