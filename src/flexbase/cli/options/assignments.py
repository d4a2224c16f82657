"""Words of a command line that give names a text each."""

from __future__ import annotations

import re

from flexbase.errors import InputError

Assignments = tuple[tuple[str, str], ...]


def assignments(text: str, option: str) -> Assignments:
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
