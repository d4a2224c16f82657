"""A layout in numbers: what `flexbase layout` shows."""

from __future__ import annotations

from rich.console import RenderableType

from flexbase.cli.terminal.show import facts, table, title, verdict
from flexbase.sheets.numbers import number
from flexbase.study.layout.best_layout import Layout


def moved(found: Layout) -> list[RenderableType]:
    """The move, and a row a target."""
    moves = [f"{row} {number(value, 5)} m" for row, value in zip(found.along, found.shift.tolist(), strict=True)]
    turned = [("turned about", f"{_centre(found)}, by {number(found.turn, 5)} rad, before")] if found.turn else []
    said = [
        (one.name, one.value, other.value, other.branch) for one, other in zip(found.before, found.after, strict=True)
    ]
    rows = [[name, _said(before), _said(after), branch or ""] for name, before, after, branch in said]
    rows.append([found.goal, _said(found.score(found.before)), _said(found.score(found.after)), ""])
    unit = "" if found.measure.unit == "1" else f" [{found.measure.unit}]"
    lost = found.unreachable
    return [
        title(found.plant.name, f"layout by the {found.goal} {found.measure.name}{unit}"),
        "",
        facts([("move the work by", ", ".join(moves) or "nothing"), *turned, ("or the base", "the opposite way")]),
        table(["target", "before", "after", "branch"], rows, words=(0, 3)),
        verdict(not lost, "All in reach", f"Out of reach: {', '.join(lost)}"),
    ]


def _centre(found: Layout) -> str:
    """The vertical of a turn."""
    return f"x {number(found.centre[0], 5)} m, y {number(found.centre[1], 5)} m"


def _said(value: float | None) -> str:
    return "out of reach" if value is None else number(value, 6)
