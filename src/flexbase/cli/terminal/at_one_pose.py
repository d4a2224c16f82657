"""The highest safe gains, and where one controller stays valid: as tables."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import RenderableType
from rich.padding import Padding
from rich.text import Text

from flexbase.cli.terminal.show import BAD, GOOD, table
from flexbase.study.running.region import Region
from flexbase.study.running.safe_gain import SafeGain


def gain_tables(found: Sequence[SafeGain]) -> list[RenderableType]:
    """The highest safe and the highest stable scale of the gains."""
    rows = [
        [
            f"{one.method}{' (not below all of it)' if one.unsafe_below else ''}",
            "none" if one.safe is None else f"{one.safe:.3g}",
            "-" if one.safe_stiffness is None else f"{one.safe_stiffness:.3g}",
            "none" if one.stable is None else f"{one.stable:.3g}",
        ]
        for one in found
    ]
    columns = ("method", "safe up to\n[times the gains]", "stiffness there\n[N/m]", "stable up to\n[times the gains]")
    return ["", "  Highest gains (s Kp, root of s Kv), s from 0.001 to 100", table(columns, rows)]


def region_lines(found: Region) -> list[RenderableType]:
    """How far a constant controller carries."""
    good = found.safe_radius is not None
    lines = [line.strip() for line in found.summary().splitlines()]
    return ["", *(Padding(Text(line, style=GOOD if good else BAD), (0, 0, 0, 2)) for line in lines)]
