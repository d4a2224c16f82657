"""Cautions: accepted, but the user should know. Data on results, without process-wide hooks.

A room says `caution(...)`. A verb that keeps them opens `collected()` and puts what was said on its result; it is then
said again outside. Where nobody collects, a caution is a `FlexbaseWarning`.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from flexbase.errors import FlexbaseWarning

_SAID: ContextVar[list[str] | None] = ContextVar("flexbase_cautions", default=None)
_HERE = str(Path(__file__).parent)


def caution(text: str) -> None:
    """Say a caution, to whoever collects in this thread, else as a warning at the first caller outside the package."""
    said = _SAID.get()
    if said is None:
        warnings.warn(text, FlexbaseWarning, stacklevel=_outside())
    elif text not in said:
        said.append(text)


@contextmanager
def collected(*, quietly: bool = False) -> Iterator[list[str]]:
    """Within, cautions of this thread are added to the list; after it they are said again, unless `quietly`."""
    said: list[str] = []
    token = _SAID.set(said)
    try:
        yield said
    finally:
        _SAID.reset(token)
        for text in () if quietly else said:
            caution(text)


def _outside() -> int:
    """Stack level, as `warnings.warn` in `caution` counts it, of the first frame that is not the package's own."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and (
        frame.f_code.co_filename.startswith(_HERE) or frame.f_code.co_filename.endswith("contextlib.py")
    ):
        level, frame = level + 1, frame.f_back
    return level
