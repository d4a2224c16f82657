"""The options of a command line from a request: text, unit, default and choices are those of its fields.

    @from_request(RUN, names={"engine": "--plant"})
    class MoveOptions(Move):
        "Times, laws and plant of a simulation."

What is read is then the request itself.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import fields
from functools import partial
from types import UnionType
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

from cyclopts import Group, Parameter

from flexbase.checks import choose
from flexbase.cli.options.common import option
from flexbase.cli.options.words import Ranges, Vector, counts, names, number, numbers, ranges, whole
from flexbase.requests import Option, options_of

Request = TypeVar("Request")
Reader = Callable[[str, str], Any]
READERS: dict[Any, tuple[Reader, str]] = {  # of a kind of field, and how its value is pictured
    float: (number, "X"),
    int: (whole, "N"),
    str: (lambda text, _: text, "NAME"),
    Vector: (numbers, "X,Y"),
    tuple[int, ...]: (counts, "N,N"),
    tuple[str, ...]: (names, "A,B"),
    Ranges: (ranges, "NAME=LO:HI:N"),
}


def from_request(
    group: Group,
    *,
    names: Mapping[str, str | tuple[str, ...]] | None = None,
    readers: Mapping[str, Reader] | None = None,
    without: Collection[str] = (),
) -> Callable[[type[Request]], type[Request]]:
    """Decorator of a subclass that adds nothing to a request, so that a command line gives it.

    names : field -> option, where it is not the field's own name; readers : field -> what turns its word into a value
    without : fields that the command line does not give
    """

    def decorate(cls: type[Request]) -> type[Request]:
        options = {one.name: one for one in options_of(cls) if one.name not in without}
        annotations: dict[str, Any] = {one.name: Annotated[Any, Parameter(parse=False)] for one in fields(cls)}  # type: ignore[arg-type]
        for field, one in options.items():
            said = _parameter(one, (names or {}).get(field), (readers or {}).get(field))
            annotations[field] = Annotated[one.kind, said]
        cls.__annotations__ = annotations
        decorated: type[Request] = Parameter(name="*", group=group)(cls)
        return decorated

    return decorate


def _parameter(one: Option, name: str | tuple[str, ...] | None, reader: Reader | None) -> Parameter:
    kind = _without_none(one.kind)
    if kind is bool:
        return Parameter(name, help=help_of(one), negative=())
    read, picture = READERS.get(kind, (None, "WORD"))
    if one.choices and kind is str:
        read = partial(_choice, one.choices)
    if reader is None and read is None:
        raise TypeError(f"{one.name}: no reader for {one.kind}")
    return option(reader or read, one.written or picture, help_of(one), name)  # type: ignore[arg-type]


def help_of(one: Option) -> str:
    """Text, choices or default, unit: "end of the run [s], 0.4"."""
    said = one.text
    if one.choices:
        words = [f"{word} (if left out)" if word == one.default else word for word in one.choices]
        said += ": " + " or ".join(filter(None, (", ".join(words[:-1]), words[-1])))
    if one.unit:
        said += f" [{one.unit}]"
    if not one.choices and isinstance(one.default, float | int | str) and one.default not in (False, ""):
        said += f", {one.default:g}" if isinstance(one.default, float) else f", {one.default}"
    return said


def _without_none(kind: Any) -> Any:
    """The kind that is meant where None is allowed, too."""
    if get_origin(kind) not in (Union, UnionType):
        return kind
    (meant,) = (one for one in get_args(kind) if one is not type(None))
    return meant


def _choice(choices: tuple[str, ...], text: str, option: str) -> str:
    choose(option, text, dict.fromkeys(choices))
    return text
