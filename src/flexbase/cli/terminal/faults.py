"""Faults and cautions as one line on stderr, and the exit status of each kind."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from cyclopts import CycloptsError

from flexbase.cautions import collected
from flexbase.cli.terminal.usage import command_line_fault
from flexbase.errors import FlexbaseError, Infeasible

NO, WRONG, BROKEN, NO_OUTPUT = 1, 2, 70, 74  # the answer is no; the input is wrong; flexbase itself is; a full disk
TRACEBACK = "FLEXBASE_TRACEBACK"  # environment variable: let faults of flexbase itself through


def report(fault: Exception, commands: Sequence[str]) -> int:
    """Say what went wrong in a line on stderr; returns the exit status."""
    if isinstance(fault, CycloptsError):
        return _say("error", command_line_fault(fault, commands), WRONG)
    if isinstance(fault, FlexbaseError):
        return _say("error", str(fault), NO if isinstance(fault, Infeasible) else WRONG)
    if isinstance(fault, MemoryError):
        return _say("error", f"not enough memory: {fault}. Ask for fewer cells or samples.", WRONG)
    if isinstance(fault, OSError) and fault.filename is None:
        silence_stdout()
        why = f"standard output cannot be written ({fault.strerror})"
        return _say("error", f"{why}. Make room, or send it elsewhere.", NO_OUTPUT)
    if os.environ.get(TRACEBACK):
        raise fault
    what = f"{type(fault).__name__}: {fault}"
    return _say("error", f"flexbase failed: {what}. Please report it, with what {TRACEBACK}=1 shows.", BROKEN)


@contextmanager
def one_line_cautions() -> Iterator[None]:
    """Cautions said within are then lines on stderr, each once.

    So are warnings of other packages, without their place in the source. Python records those for the whole process
    only, which here is the program's own.
    """
    foreign: list[warnings.WarningMessage] = []
    said: list[str] = []
    try:
        with warnings.catch_warnings(record=True) as foreign, collected(quietly=True) as said:
            yield
    finally:
        for text in dict.fromkeys([*said, *(str(one.message) for one in foreign)]):
            _say("warning", text, 0)


def silence_stdout() -> None:
    """The reader has gone (`flexbase ... | head -1`) or the disk is full: nothing more can or need be said."""
    if sys.stdout is None:
        return
    devnull = os.open(os.devnull, os.O_WRONLY)
    os.dup2(devnull, sys.stdout.fileno())


def _say(kind: str, text: str, status: int) -> int:
    if sys.stderr is None:
        return status
    encoding = sys.stderr.encoding or "utf-8"
    line = f"{kind}: {' '.join(text.split())}"
    print(line.encode(encoding, "backslashreplace").decode(encoding), file=sys.stderr)
    return status
