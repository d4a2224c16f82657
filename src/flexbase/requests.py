"""What is asked for: what each value means, its unit and how it is written. Python, command line and page share it.

A request is a frozen dataclass whose fields are made by `asked`; a method is a function whose signature is annotated
with `Says`. Whoever asks a person for either reads `options_of`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from inspect import signature
from typing import Any, NamedTuple, get_type_hints

Progress = Callable[[str, int, int], None]  # what is being done, how much of it is done, how much there is


def no_progress(what: str, done: int, total: int) -> None:
    """Nobody watches."""


class Says(NamedTuple):
    """What a value is: `Annotated[float, Says("bound on the radius", unit="1")]`.

    text : in a few words; unit : "" where it has none; written : a picture of it, "X,Y"
    choices : the values that are valid, where they can be listed
    """

    text: str
    unit: str = ""
    written: str = ""
    choices: tuple[str, ...] = ()


class Option(NamedTuple):
    """One field of a request, or one option of a method: the rest as `Says` has it.

    kind : its type, such as `float`, `int`, `bool`, `str`, `tuple[float, ...]`, or one of these or None
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
    return dataclasses.field(default=default, metadata={"says": Says(text, unit, written, choices)})


def options_of(request: Callable[..., Any]) -> tuple[Option, ...]:
    """The fields of a request that `asked` made, or what a function's signature says, in their order."""
    kinds = get_type_hints(request, include_extras=True)
    if dataclasses.is_dataclass(request):
        said = [(one, one.metadata.get("says")) for one in dataclasses.fields(request)]
        return tuple(Option(one.name, kinds[one.name], one.default, *says) for one, says in said if says)
    parameters = signature(request).parameters.values()
    marked = [(one, says) for one in parameters for says in getattr(kinds.get(one.name), "__metadata__", ())]
    return tuple(Option(one.name, kinds[one.name].__origin__, one.default, *says) for one, says in marked)
