"""The options of a command line from what is asked: text, unit, default and choices are said where they are used.

    @from_request(RUN, names={"engine": "--plant"})
    class MoveOptions(Move):
        "Times, laws and plant of a simulation."

What is read is then the request itself. The options of all methods of a registry together come from their signatures:

    @from_methods(METHOD, METHODS)
    @dataclass(frozen=True)
    class MethodOptions:
        "How a compensator is designed."
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import field, fields, make_dataclass
from functools import partial
from types import UnionType
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, Union, get_args, get_origin, get_type_hints

from cyclopts import Group, Parameter

from flexbase.checks import choose
from flexbase.cli.options.common import option
from flexbase.cli.options.values import Range, Vector, counts, names, number, number_or_numbers, numbers, ranges, whole
from flexbase.requests import Option, options_of

if TYPE_CHECKING:  # the methods themselves take long to import
    from flexbase.compensators import Method
    from flexbase.synthesis.registry import HardwareMethod

Request = TypeVar("Request")
Reader = Callable[[str, str], Any]
READERS: dict[Any, tuple[Reader, str]] = {  # of a kind of field, and how its value is pictured
    float: (number, "X"),
    int: (whole, "N"),
    str: (lambda text, _: text, "NAME"),
    Vector: (numbers, "X,Y"),
    float | Vector: (number_or_numbers, "X,Y"),
    tuple[int, ...]: (counts, "N,N"),
    tuple[str, ...]: (names, "A,B"),
    Mapping[str, Range]: (lambda text, name: dict(ranges(text, name)), "NAME=LO:HI:N"),
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
        for name, one in options.items():
            said = _parameter(one, (names or {}).get(name), (readers or {}).get(name))
            annotations[name] = Annotated[one.kind, said]
        cls.__annotations__ = annotations
        decorated: type[Request] = Parameter(name="*", group=group)(cls)
        return decorated

    return decorate


def from_methods(
    group: Group, methods: Mapping[str, Method | HardwareMethod]
) -> Callable[[type[Request]], type[Request]]:
    """Decorator of a dataclass that adds the options of all methods, each None where it is not given.

    Methods that share an option share it here; the help says what it means to which.
    """
    asked: dict[str, dict[str, Option]] = {}
    for method, known in methods.items():
        for one in known.options:
            asked.setdefault(one.name, {})[method] = one

    def decorate(cls: type[Request]) -> type[Request]:
        own = get_type_hints(cls, include_extras=True)
        all_fields: Any = [(one.name, own[one.name], field(default=one.default)) for one in fields(cls)]  # type: ignore[arg-type]
        all_fields += [(name, _shared(by_method), field(default=None)) for name, by_method in asked.items()]
        made = make_dataclass(cls.__name__, all_fields, bases=(cls,), frozen=True)
        made.__doc__, made.__module__ = cls.__doc__, cls.__module__
        decorated: type[Request] = Parameter(name="*", group=group)(made)
        return decorated

    return decorate


def options_given(options: object) -> dict[str, Any]:
    """Of what `from_methods` added, the options that are given, under the library's names."""
    own = {one.name for base in type(options).__bases__ for one in fields(base)}
    return {name: value for name, value in vars(options).items() if name not in own and value is not None}


def _shared(by_method: Mapping[str, Option]) -> Any:
    """The annotation of an option that methods share; whether a method has a choice is for the method to say."""
    said: dict[str, list[str]] = {}
    for method, one in by_method.items():
        said.setdefault(help_of(one), []).append(method)
    text = "; ".join(f"{', '.join(methods)}: {meaning}" for meaning, methods in said.items())
    kind = _without_none(Union[tuple(one.kind for one in by_method.values())])  # noqa: UP007
    read, picture = READERS[kind]
    written = {one.written or picture for one in by_method.values()}
    return Annotated[kind | None, option(read, max(written, key=len), text)]


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
    return Union[tuple(one for one in get_args(kind) if one is not type(None))]  # noqa: UP007


def _choice(choices: tuple[str, ...], text: str, option: str) -> str:
    choose(option, text, dict.fromkeys(choices))
    return text
