"""The bar of a map: cells, rate and time left; an interruption says what is kept and how to go on."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    Task,
    TaskProgressColumn,
    TextColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from flexbase.requests import Progress as Report


class _Rate(ProgressColumn):
    """Cells a second."""

    def render(self, task: Task) -> Text:
        speed = task.finished_speed or task.speed
        return Text("" if speed is None else f"{speed / 1e6:.3g} million cells/s")


@contextmanager
def cells_bar(store: Path | str | None) -> Iterator[Report]:
    """A bar with rate and time left for (what, done, total); an interruption says what is kept and how to go on."""
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

        def move(_: str, done: int, total: int) -> None:
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
