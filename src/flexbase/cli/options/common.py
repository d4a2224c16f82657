"""Options of one word, and those that most commands share."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Group, Parameter, Token

from flexbase.errors import InputError


def option(
    read: Callable[[str, str], Any],
    metavar: str,
    text: str,
    name: str | Sequence[str] | None = None,
    group: Group | None = None,
) -> Parameter:
    """An option of one word, which may begin with a minus, given at most once; `read` turns it into a value."""

    def convert(_: Any, tokens: Sequence[Token]) -> Any:
        return read(tokens[0].value, tokens[0].keyword or metavar)

    word: dict[str, Any] = {
        "n_tokens": 1,
        "accepts_keys": False,
        "allow_leading_hyphen": True,
        "allow_repeating": False,
    }
    if group is not None:  # cyclopts hides an option whose group is given as None
        word["group"] = group
    return Parameter(name, converter=convert, metavar=metavar, help=text, negative=(), **word)


@contextmanager
def blaming(option: str) -> Iterator[None]:
    """Within, a fault of the library names the option that brought it."""
    try:
        yield
    except InputError as fault:
        raise type(fault)(f"{option}: {str(fault).removeprefix('tip: ').removeprefix('compensator: ')}") from fault


Json = Annotated[bool, Parameter(help="one JSON document on stdout, nothing else")]
CompensatorFile = Annotated[Path | None, Parameter(metavar="FILE", help="compensator that design --out wrote")]
