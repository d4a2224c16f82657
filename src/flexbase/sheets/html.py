"""A sheet as HTML, for notebooks and pages. All words are escaped."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from html import escape

from flexbase.sheets.sheet import BAD, GOOD, Answer, Facts, Note, Part, Sheet, Table
from flexbase.sheets.text import printable

COLOURS = {GOOD: "#1a7f37", BAD: "#b42318"}


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
            yield _table((), (_row("td", row, ("left", "left")) for row in part.rows), part.heading)
        case Table():
            sides = ["left" if column.words else "right" for column in part.columns]
            head = _row("th", (column.head for column in part.columns), sides)
            yield _table((head,), (_row("td", row, sides) for row in part.rows), part.heading)
        case Answer():
            colour = f' style="color:{COLOURS[part.tone]}"' if part.tone in COLOURS else ""
            rest = f". {_safe(part.rest)}" if part.rest else ""
            yield f"<p><strong{colour}>{_safe(part.sentence)}</strong>{rest}</p>"
        case Note():
            yield _element("p", part.text)


def _table(head: Iterable[str], body: Iterable[str], heading: str) -> str:
    caption = _element("caption", heading, "text-align:left") if heading else ""
    above = "".join(head)
    return f"<table>{caption}{above and f'<thead>{above}</thead>'}<tbody>{''.join(body)}</tbody></table>"


def _row(kind: str, cells: Iterable[str], sides: Iterable[str]) -> str:
    at = "bottom" if kind == "th" else "top"
    style = f"vertical-align:{at};padding:0.1em 0.7em"
    filled = (_element(kind, cell, f"text-align:{side};{style}") for cell, side in zip(cells, sides, strict=True))
    return f"<tr>{''.join(filled)}</tr>"


def _element(kind: str, words: str, style: str = "") -> str:
    """Words with their lines. Where there are several, all signs are as wide: a matrix keeps its columns."""
    even = ";font-family:monospace" if "\n" in words and kind != "th" else ""
    return f'<{kind} style="white-space:pre-wrap;{style}{even}">{_safe(words)}</{kind}>'


def _safe(words: str) -> str:
    return escape(printable(words))
