"""A sheet as HTML, for notebooks and pages. All words are escaped."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from html import escape

from flexbase.sheets.sheet import BAD, GOOD, Answer, Facts, Note, Part, Sheet, Table
from flexbase.sheets.text import printable

COLOURS = {GOOD: "#1a7f37", BAD: "#b42318"}
_LEFT, _RIGHT = 'style="text-align:left;white-space:pre-wrap"', 'style="text-align:right;white-space:pre-wrap"'


def html(sheet: Sheet) -> str:
    """The sheet as one `<div>`."""
    cautions = (f"<p>caution: {_safe(one)}</p>" for one in sheet.cautions)
    return f'<div class="flexbase-sheet">{"".join([*_sheet(sheet), *cautions])}</div>'


def _sheet(sheet: Sheet) -> Iterator[str]:
    rest = f" <small>{_safe(sheet.rest)}</small>" if sheet.rest else ""
    yield f"<p><strong>{_safe(sheet.title)}</strong>{rest}</p>"
    for part in sheet.parts:
        yield from _part(part)


def _part(part: Part) -> Iterator[str]:
    match part:
        case Sheet():
            yield from _sheet(part)
        case Facts():
            yield _table((), (_row("td", row, (_LEFT, _LEFT)) for row in part.rows), part.heading)
        case Table():
            sides = [_LEFT if column.words else _RIGHT for column in part.columns]
            head = _row("th", (column.head for column in part.columns), sides)
            yield _table((head,), (_row("td", row, sides) for row in part.rows), part.heading)
        case Answer():
            colour = f' style="color:{COLOURS[part.tone]}"' if part.tone in COLOURS else ""
            rest = f". {_safe(part.rest)}" if part.rest else ""
            yield f"<p><strong{colour}>{_safe(part.sentence)}</strong>{rest}</p>"
        case Note():
            yield f"<p>{_safe(part.text)}</p>"


def _table(head: Iterable[str], body: Iterable[str], heading: str) -> str:
    caption = f"<caption>{_safe(heading)}</caption>" if heading else ""
    above = "".join(head)
    return f"<table>{caption}{above and f'<thead>{above}</thead>'}<tbody>{''.join(body)}</tbody></table>"


def _row(kind: str, cells: Iterable[str], sides: Iterable[str]) -> str:
    return (
        f"<tr>{''.join(f'<{kind} {side}>{_safe(cell)}</{kind}>' for cell, side in zip(cells, sides, strict=True))}</tr>"
    )


def _safe(words: str) -> str:
    return escape(printable(words))
