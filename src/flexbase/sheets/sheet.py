"""A result as people read it, once: heading, facts, tables, answers. What renders it decides on lines and colours."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeAlias

GOOD, BAD, NEUTRAL = "good", "bad", "neutral"


class Fact(NamedTuple):
    """A name and what it is; a value may have several lines."""

    name: str
    value: str


class Column(NamedTuple):
    """What a table has under one heading.

    words : aligned left; numbers are aligned right
    widest : characters, beyond which words are folded where room is scarce
    """

    heading: str
    unit: str = ""
    words: bool = False
    widest: int | None = None

    @property
    def head(self) -> str:
        """Heading and unit, one below the other."""
        return f"{self.heading}\n[{self.unit}]" if self.unit else self.heading


@dataclass(frozen=True)
class Facts:
    """Facts, one a line."""

    rows: tuple[Fact, ...]
    heading: str = ""


@dataclass(frozen=True)
class Table:
    """Columns, and a text for each of them in every row."""

    columns: tuple[Column, ...]
    rows: tuple[tuple[str, ...], ...]
    heading: str = ""


@dataclass(frozen=True)
class Answer:
    """What a result comes to, in a sentence, and the words that qualify it.

    tone : GOOD, BAD or NEUTRAL
    """

    tone: str
    sentence: str
    rest: str = ""


@dataclass(frozen=True)
class Note:
    """A paragraph."""

    text: str


@dataclass(frozen=True)
class Sheet:
    """A heading and what stands below it, in order; another sheet may be a part.

    rest : quiet words behind the title
    cautions : what should be known of the result, beside what it says
    """

    title: str
    rest: str = ""
    parts: tuple[Part, ...] = ()
    cautions: tuple[str, ...] = ()


Part: TypeAlias = Facts | Table | Answer | Note | Sheet


def make_sheet(title: str, rest: str, *parts: Part | None, cautions: Iterable[str] = ()) -> Sheet:
    """A sheet of the parts that have something to say."""
    return Sheet(
        title, rest, tuple(part for part in parts if part is not None and not _is_empty(part)), tuple(cautions)
    )


def facts(*rows: tuple[str, str] | None, heading: str = "") -> Facts:
    """Facts, without those that there are not."""
    return Facts(tuple(Fact(*row) for row in rows if row is not None), heading)


def table(columns: Sequence[Column], rows: Iterable[Sequence[str]], heading: str = "") -> Table:
    """A table. Every row has a text for each column; if one has not, ValueError."""
    return Table(
        tuple(columns), tuple(tuple(text for text, _ in zip(row, columns, strict=True)) for row in rows), heading
    )


def answer(good: bool, yes: str, no: str, rest: str = "") -> Answer:
    """Yes or no."""
    return Answer(GOOD, yes, rest) if good else Answer(BAD, no, rest)


def words(heading: str) -> Column:
    """A column of words."""
    return Column(heading, words=True)


def together(first: Sheet, *others: Sheet) -> Sheet:
    """One sheet of several: those with the same heading add the parts that are new, the others stand below it."""
    parts, cautions = list(first.parts), list(first.cautions)
    for other in others:
        same = (other.title, other.rest) == (first.title, first.rest)
        added = other.parts if same else (replace(other, cautions=()),)
        parts += [part for part in added if part not in parts]
        cautions += [text for text in other.cautions if text not in cautions]
    return replace(first, parts=tuple(parts), cautions=tuple(cautions))


def _is_empty(part: Part) -> bool:
    return isinstance(part, Facts | Table) and not part.rows
