"""Sheets as they are read back from each medium: the signs that a person sees, without layout."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from html.parser import HTMLParser

import pytest

from flexbase.cli.terminal.screen import put
from flexbase.sheets.sheet import Answer, Facts, Note, Part, Sheet, Table
from flexbase.sheets.text import printable

RULE = re.compile(r" *(-{4,}|─{4,})")
LAYOUT = set(":.")  # put after headings, and between an answer and what qualifies it


class Page(HTMLParser):
    """The words of a page and the names of its elements."""

    def __init__(self, source: str) -> None:
        super().__init__()
        self.words, self.elements = "", Counter[str]()
        self.open: list[str] = []
        self.feed(source)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements[tag] += 1
        self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words += data + "\n"


def signs(shown: str) -> Counter[str]:
    """How often each sign stands there, without rules, blanks and what layout adds."""
    lines = [line for line in shown.split("\n") if not RULE.fullmatch(line)]
    return Counter(sign for line in lines for sign in line if not sign.isspace() and sign not in LAYOUT)


def words_of(sheet: Sheet, cautions: bool = True) -> str:
    """All words of a sheet, one a line."""
    said = [f"caution {one}" for one in sheet.cautions] if cautions else []
    return printable("\n".join([*_words(sheet), *said]))


def _words(part: Part) -> Iterator[str]:
    match part:
        case Sheet():
            yield from (part.title, part.rest)
            for inner in part.parts:
                yield from _words(inner)
        case Facts():
            yield part.heading
            for row in part.rows:
                yield from row
        case Table():
            yield part.heading
            yield from (column.head for column in part.columns)
            for cells in part.rows:
                yield from cells
        case Answer():
            yield from (part.sentence, part.rest)
        case Note():
            yield part.text


def on_terminal(sheet: Sheet, capsys: pytest.CaptureFixture[str]) -> str:
    """What the command line prints of it."""
    capsys.readouterr()
    put(sheet)
    return capsys.readouterr().out
