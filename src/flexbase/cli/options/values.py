"""Words of a command line as values: numbers, lists, signs; each fault names its option and value."""

from __future__ import annotations

import math
import re

from flexbase.errors import InputError
from flexbase.model.task import BRANCHES

Vector = tuple[float, ...]
Names = tuple[str, ...]
Range = tuple[float, float, int]


def number(text: str, option: str) -> float:
    """A finite number. Raises InputError."""
    try:
        value = float(text)
    except ValueError:
        raise InputError(f'{option}: "{text}" is not a number. Give a number, such as 0.25 or 1e5.') from None
    if not math.isfinite(value):
        raise InputError(f'{option}: "{text}" is not finite. Give a finite number.')
    return value


def whole(text: str, option: str) -> int:
    """A whole number from 0 up. Raises InputError."""
    if not (text.isascii() and text.isdigit()):
        raise InputError(f'{option}: "{text}" is not a whole number from 0 up.')
    return int(text)


def numbers(text: str, option: str) -> Vector:
    """Numbers with commas between them. Raises InputError."""
    return tuple(number(part.strip(), option) for part in _parts(text, option))


def number_or_numbers(text: str, option: str) -> float | Vector:
    """One number, or several with commas between them. Raises InputError."""
    found = numbers(text, option)
    return found[0] if len(found) == 1 else found


def counts(text: str, option: str) -> tuple[int, ...]:
    """Whole numbers with commas between them. Raises InputError."""
    return tuple(whole(part.strip(), option) for part in _parts(text, option))


def names(text: str, option: str) -> Names:
    """Names with commas between them. Raises InputError."""
    return tuple(part.strip() for part in _parts(text, option))


def ranges(text: str, option: str) -> tuple[tuple[str, Range], ...]:
    """Names with a range each, such as stiffness=0.7:1.3:5; the count may be left out. Raises InputError."""
    found = []
    for part in _parts(text, option):
        name, _, given = part.partition("=")
        ends = given.split(":")
        if len(ends) not in (2, 3):
            raise InputError(f'{option}: "{part}" is not NAME=LOW:HIGH:COUNT. Give such as stiffness=0.7:1.3:5.')
        count = whole(ends[2].strip(), option) if len(ends) == 3 else 2
        found.append((name.strip(), (number(ends[0], option), number(ends[1], option), count)))
    return tuple(found)


def assignments(text: str, option: str) -> tuple[tuple[str, str], ...]:
    """Names with a text each, such as payload=uniform(0,3); commas in brackets do not part them. Raises InputError."""
    found: dict[str, str] = {}
    for part in re.split(r",(?![^()]*\))", text):
        name, equals, given = (word.strip() for word in part.partition("="))
        if not (name and equals and given):
            raise InputError(f'{option}: "{part}" is not NAME=KIND:A:B. Give such as payload=uniform:0:3.')
        if name in found:
            raise InputError(f"{option}: {name} is given twice. Give it once.")
        found[name] = given
    return tuple(found.items())


def sign(text: str, option: str) -> str:
    """A side of the elbow, or the three signs of shoulder, elbow and wrist. Raises InputError."""
    if text not in BRANCHES:
        raise InputError(f'{option}: "{text}" is neither + (0 < elbow angle < pi) nor -, nor three signs such as +-+.')
    return text


def _parts(text: str, option: str) -> list[str]:
    parts = text.split(",")
    if not all(part.strip() for part in parts):
        raise InputError(f'{option}: "{text}" has an empty entry. Give a list with commas, such as 0.33,-0.25.')
    return parts
