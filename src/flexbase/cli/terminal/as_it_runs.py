"""The hardware verdict beside an ideal one: three lines."""

from __future__ import annotations

from typing import Any

from rich.console import RenderableType

from flexbase.cli.terminal.show import facts, verdict
from flexbase.study.running.as_it_runs import AsItRuns


def lines(found: AsItRuns | None) -> list[RenderableType]:
    """Whether it runs, in which loop, and what to do where it does not; nothing without task gains."""
    if found is None:
        return []
    said = found.statement
    mend = [] if found.good else ["  flexbase hardware compares what is made for this loop."]
    return [
        "",
        verdict(found.good, f"{said[0].upper()}{said[1:]}", f"{said[0].upper()}{said[1:]}"),
        facts([("loop", found.loop)]),
        *mend,
    ]


def content(found: AsItRuns | None) -> dict[str, Any]:
    """The same for a JSON document."""
    return {"hardware": None if found is None else found.to_dict()}
