"""Progress on stderr: a bar on a terminal, silence or plain lines elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from flexbase.requests import Progress as Report
from flexbase.requests import no_progress


@contextmanager
def progress_bar(plain_lines: bool = False) -> Iterator[Report]:
    """A function (what, done, total) that moves the bar; off a terminal it is silent, or prints a line a tenth."""
    if not sys.stderr.isatty():
        yield _lines() if plain_lines else no_progress
        return
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(file=sys.stderr), transient=True) as bar:
        task = bar.add_task("", total=None)

        def move(what: str, done: int, total: int) -> None:
            bar.update(task, description=what, completed=done, total=total)

        yield move


def _lines() -> Report:
    tenths: set[int] = set()

    def say(what: str, done: int, total: int) -> None:
        if (tenth := 10 * done // max(total, 1)) not in tenths:
            tenths.add(tenth)
            print(f"{10 * tenth:3d} % {what}", file=sys.stderr, flush=True)

    return say
