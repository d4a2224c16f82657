"""A sheet as plain text: lines as long as they are, columns under one another."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Sequence

from flexbase.sheets.sheet import Answer, Facts, Note, Part, Sheet, Table

INDENT = "  "


def text(sheet: Sheet) -> str:
    """The sheet in lines, without one at the end."""
    cautions = [INDENT + printable(f"caution: {one}") for one in sheet.cautions]
    return "\n".join(line.rstrip() for line in [*_sheet(sheet), *cautions])


def printable(words: str) -> str:
    """The same, with a mark in place of what would steer a terminal; lines stay."""
    return "".join(sign if sign.isprintable() or sign == "\n" else "\N{REPLACEMENT CHARACTER}" for sign in words)


def _sheet(sheet: Sheet) -> Iterator[str]:
    yield printable(f"{sheet.title}  {sheet.rest}" if sheet.rest else sheet.title)
    for part, before in zip(sheet.parts, (None, *sheet.parts[:-1]), strict=True):
        if isinstance(part, Table | Sheet) or isinstance(before, Table | Sheet):
            yield ""
        yield from _part(part)


def _part(part: Part) -> Iterator[str]:
    match part:
        case Sheet():
            yield from _sheet(part)
        case Facts():
            yield from _heading(part.heading)
            yield from _grid([list(row) for row in part.rows], [True, True])
        case Table():
            yield from _heading(part.heading)
            heads = [column.head for column in part.columns]
            lines = list(_grid([heads, *part.rows], [column.words for column in part.columns], 1))
            height = max(head.count("\n") for head in heads) + 1
            yield from lines[:height]
            yield INDENT + "-" * (max(map(_width, lines)) - len(INDENT))
            yield from lines[height:]
        case Answer():
            yield from _lines(f"{part.sentence}. {part.rest}" if part.rest else part.sentence)
        case Note():
            yield from _lines(part.text)


def _heading(words: str) -> Iterator[str]:
    if words:
        yield from _lines(f"{words}:")


def _lines(words: str) -> Iterator[str]:
    for line in printable(words).split("\n"):
        yield INDENT + line


def _grid(rows: Sequence[Sequence[str]], left: Sequence[bool], heads: int = 0) -> Iterator[str]:
    """Rows of cells, which may have several lines; the first `heads` rows stand at the bottom of theirs."""
    cells = [[printable(cell).split("\n") for cell in row] for row in rows]
    widths = [max((_width(line) for row in cells for line in row[i]), default=0) for i in range(len(left))]
    for number, row in enumerate(cells):
        height = max(map(len, row))
        blanks = [[""] * (height - len(cell)) for cell in row]
        even = [b + c if number < heads else c + b for b, c in zip(blanks, row, strict=True)]
        for i in range(height):
            parts = zip((cell[i] for cell in even), widths, left, strict=True)
            yield INDENT + "  ".join(_padded(part, width, at_left) for part, width, at_left in parts)


def _padded(words: str, width: int, at_left: bool) -> str:
    room = " " * (width - _width(words))
    return words + room if at_left else room + words


def _width(words: str) -> int:
    """Cells of a terminal: two of a wide sign, none of one that stands above another."""
    wide = sum(unicodedata.east_asian_width(sign) in "WF" for sign in words)
    return len(words) + wide - sum(unicodedata.combining(sign) > 0 for sign in words)
