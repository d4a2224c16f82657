"""A sheet on a terminal: as wide as it is, in colour only there."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import NoReturn

from rich import box
from rich.cells import cell_len
from rich.console import Console, RenderableType
from rich.padding import Padding
from rich.table import Table as Grid
from rich.text import Text

from flexbase.sheets.sheet import BAD, GOOD, Answer, Facts, Note, Part, Sheet, Table
from flexbase.sheets.text import printable

QUIET, HEAD = "dim", "bold"
LONG = 40  # signs of a fact's name, above which it is folded
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
            for part in _sheet(one, screen) if isinstance(one, Sheet) else (one,):
                screen.print(part, soft_wrap=isinstance(part, str))
    encoding = sys.stdout.encoding or "utf-8"
    text = "\n".join(line.rstrip() for line in captured.get().split("\n"))
    sys.stdout.write(text.encode(encoding, "replace").decode(encoding))


def _sheet(sheet: Sheet, screen: Console) -> Iterator[RenderableType]:
    """Its parts with a blank line between them; cautions go to stderr, where the program says them."""
    rest = printable(f"  {sheet.rest}") if sheet.rest else ""
    yield Text.assemble((printable(sheet.title), HEAD), (rest, QUIET))
    for part in sheet.parts:
        yield ""
        yield from _part(part, screen)


def _part(part: Part, screen: Console) -> Iterator[RenderableType]:
    match part:
        case Sheet():
            yield from _sheet(part, screen)
        case Facts():
            yield from _heading(part.heading)
            yield _indented(_facts(part))
        case Table():
            yield from _heading(part.heading)
            yield _indented(_table(part, screen.width))
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
    grid.add_column(style=QUIET, no_wrap=all(len(name) <= LONG for name, _ in found.rows), overflow="fold")
    grid.add_column(overflow="fold")
    for name, value in found.rows:
        grid.add_row(Text(printable(name)), Text(printable(value)))
    return grid


def _table(found: Table, width: int) -> Grid:
    """Numbers are folded only where a column asks for it or the screen has no room for them."""
    whole = not any(column.widest for column in found.columns) and _least_width(found) <= width
    drawn = Grid(box=box.SIMPLE_HEAD, header_style=HEAD, pad_edge=False, show_edge=False)
    for one in found.columns:
        side = {"justify": "left"} if one.words else {"justify": "right", "no_wrap": whole}
        drawn.add_column(Text(printable(one.head)), overflow="fold", max_width=one.widest, **side)
    for row in found.rows:
        drawn.add_row(*(Text(printable(cell)) for cell in row))
    return drawn


def _least_width(found: Table) -> int:
    """Columns of the screen that the table takes with its numbers whole, blanks counted."""
    cells = zip(*([column.head for column in found.columns], *found.rows), strict=True)
    parts = (
        [part for cell in down for part in (cell.split() if one.words else cell.split("\n"))]
        for one, down in zip(found.columns, cells, strict=True)
    )
    return sum(max(map(cell_len, column), default=0) + 3 for column in parts)


def _indented(part: RenderableType) -> Padding:
    return Padding(part, (0, 0, 0, 2))
