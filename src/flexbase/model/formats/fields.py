"""Attributes of an XML element as names, words and finite numbers, strictly. Messages never repeat a value."""

from __future__ import annotations

import math
import re
from collections.abc import Collection

from flexbase.errors import InputError
from flexbase.model.formats.guard import LONGEST_NAME, Element, listed, place

NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
LONGEST_TEXT = 1000  # characters of an attribute that holds numbers
LARGEST = 1e9  # of a mass, length or inertia, in SI units

Numbers = tuple[float, ...]


def name_of(element: Element, key: str = "name") -> str:
    """A name: present, printable and of sane length. Raises InputError."""
    name = element.attributes.get(key, "")
    if not name.strip():
        raise InputError(f"{place(element)}: {key} is missing or empty. Give it.")
    if len(name) > LONGEST_NAME:
        raise InputError(f"{place(element)}: {key} has more than {LONGEST_NAME} characters. Shorten it.")
    if not name.isprintable():
        raise InputError(f"{place(element)}: {key} has characters that cannot be printed. Rename it.")
    return name


def word(element: Element, key: str, valid: Collection[str]) -> str:
    """A word from a fixed list. Raises InputError."""
    text = element.attributes.get(key, "")
    if text not in valid:
        choice = f"one of {', '.join(sorted(valid))}" if len(valid) <= 8 else "a word that the format knows"
        raise InputError(f"{place(element)}: {key} must be {choice}. Correct it.")
    return text


def numbers(element: Element, key: str, least: int, most: int | None = None, *, largest: float = LARGEST) -> Numbers:
    """Finite numbers separated by white space, `least` to `most` of them. Raises InputError."""
    most = least if most is None else most
    text = element.attributes.get(key)
    needed = f"{least} to {most} numbers" if most > least else f"{least} number{'s' * (least > 1)}"
    if text is None:
        raise InputError(f"{place(element)}: {key} is missing. Give {needed}.")
    if "$" in text:
        raise InputError(f"{place(element)}: {key} holds an unexpanded xacro. Run the file through xacro first.")
    words = text.split() if len(text) <= LONGEST_TEXT else []
    if not least <= len(words) <= most or not all(len(one) <= 64 and NUMBER.fullmatch(one) for one in words):
        raise InputError(f"{place(element)}: {key} is not plain numbers. Give {needed} in SI units, without units.")
    values = tuple(map(float, words))
    if not all(math.isfinite(value) and abs(value) <= largest for value in values):
        raise InputError(f"{place(element)}: {key} is not finite or beyond {largest:g}. Give {needed} in SI units.")
    return values


def number(element: Element, key: str, *, largest: float = LARGEST) -> float:
    """One finite number. Raises InputError."""
    return numbers(element, key, 1, largest=largest)[0]


def vector(element: Element | None, key: str, default: Numbers) -> Numbers:
    """As many finite numbers as the default has; the default where there is nothing. Raises InputError."""
    if element is None or key not in element.attributes:
        return default
    return numbers(element, key, len(default))


def direction(element: Element | None, key: str, default: Numbers) -> Numbers:
    """A vector scaled to length 1. Raises InputError where it is zero."""
    values = vector(element, key, default)
    length = math.hypot(*values)
    if length < 1e-6:
        where = f"{place(element)}: " if element is not None else ""
        raise InputError(f"{where}{key} is zero, so it has no direction. Give a nonzero one.")
    return tuple(value / length for value in values)


def refuse_repeated(what: str, names: list[str]) -> None:
    """Raise InputError where a name stands for two things."""
    seen: set[str] = set()
    repeated = [name for name in names if name in seen or seen.add(name)]  # type: ignore[func-returns-value]
    if repeated:
        raise InputError(f"{what} {listed(repeated)}: the name is given twice. Rename one.")
