"""Fields of a request: what each means, its unit and how it is written. Python, command line and page share them.

A request is a frozen dataclass whose fields are made by `asked`. Whoever asks a person for it reads `options_of`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, NamedTuple, get_type_hints

Progress = Callable[[str, int, int], None]  # what is being done, how much of it is done, how much there is


def no_progress(what: str, done: int, total: int) -> None:
    """Nobody watches."""


class Option(NamedTuple):
    """One field of a request.

    kind : its type, such as `float`, `int`, `bool`, `str`, `tuple[float, ...]`, or one of these or None
    text : what it is, in a few words; unit : of the value, "" where it has none; written : a picture of it, "X,Y"
    choices : the values that are valid, where they can be listed
    """

    name: str
    kind: Any
    default: Any
    text: str
    unit: str
    written: str
    choices: tuple[str, ...]


def asked(
    default: Any, text: str, *, unit: str = "", written: str = "", choices: tuple[str, ...] = ()
) -> Any:  # a field, typed as its value as `dataclasses.field` itself is
    """A field of a request, with its default."""
    said = {"text": text, "unit": unit, "written": written, "choices": choices}
    return dataclasses.field(default=default, metadata=said)


def options_of(request: type) -> tuple[Option, ...]:
    """The fields of a request that `asked` made, in their order."""
    kinds = get_type_hints(request)
    return tuple(
        Option(one.name, kinds[one.name], one.default, **one.metadata)
        for one in dataclasses.fields(request)
        if "text" in one.metadata
    )
