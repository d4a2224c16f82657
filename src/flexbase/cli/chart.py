"""A map in numbers: its axes, its cells and the extent of its measures."""

from __future__ import annotations

from rich.console import RenderableType

from flexbase.cli.digits import number
from flexbase.cli.show import facts, table, title
from flexbase.measures import MEASURES
from flexbase.sweep import STATUS, Chart


def tables(found: Chart) -> list[RenderableType]:
    """Heading, axes and cells, and the smallest and largest value of each measure."""
    rows = []
    for name, values in found.values.items():
        modes = values.shape[-1] if values.ndim == 3 else 0
        for i, part in enumerate([values[..., i] for i in range(modes)] if modes else [values], start=1):
            known = part[part == part]
            extent = [number(known.min(), 7), number(known.max(), 7)] if known.size else ["none", "none"]
            rows.append([name, str(i) if modes else "", *extent, MEASURES[name].unit])
    axes = [
        f"{a.name} {number(a.values[0], 6)} to {number(a.values[-1], 6)} {a.unit}, {a.values.size} cells"
        for a in found.axes
    ]
    cells = [(meaning, f"{found.count(code)} cells") for code, meaning in STATUS.items() if found.count(code)]
    zeros = [(f"{name} = 0", MEASURES[name].zero_is or "") for name in found.values if MEASURES[name].zero_is]
    heading = f"map {'with' if found.compensated else 'without'} compensator"
    columns = ["measure", "mode", "smallest", "largest", "unit"]
    said = [("first axis", axes[0]), ("second axis", axes[1]), *cells, *zeros]
    return [title(found.plant.name, heading), "", facts(said), table(columns, rows, words=(0, 4), blank_after=False)]
