"""Progress on stderr: a bar on a terminal, silence or plain lines elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.text import Text

Report = Callable[[str, int, int], None]


@contextmanager
def progress_bar(plain_lines: bool = False) -> Iterator[Report]:
    """A function (what, done, total) that moves the bar; off a terminal it is silent, or prints a line a tenth."""
    if not sys.stderr.isatty():
        yield _lines() if plain_lines else lambda _what, _done, _total: None
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


class _Rate(ProgressColumn):
    """Cells a second."""

    def render(self, task: Task) -> Text:
        speed = task.finished_speed or task.speed
        return Text("" if speed is None else f"{speed / 1e6:.3g} million cells/s")


@contextmanager
def cells_bar(store: Path | None) -> Iterator[Callable[[int, int], None]]:
    """A bar with rate and time left for (done, total); an interruption says what is kept and how to go on."""
    state = [0, 0]
    columns = (TextColumn("cells"), BarColumn(), TaskProgressColumn(), _Rate(), TimeRemainingColumn())
    with Progress(
        *columns,
        console=Console(file=sys.stderr),
        transient=True,
        disable=not sys.stderr.isatty(),
        speed_estimate_period=10,
    ) as bar:
        task = bar.add_task("", total=None)

        def move(done: int, total: int) -> None:
            state[:] = done, total
            bar.update(task, completed=done, total=total)

        try:
            yield move
        except KeyboardInterrupt:
            bar.stop()
            kept = f"{store} keeps {state[0]} of {state[1]} cells. Go on with the same command and --resume."
            print(
                kept if store else "stopped: nothing was kept. Give --out NAME.zarr to be able to go on.",
                file=sys.stderr,
            )
            raise
