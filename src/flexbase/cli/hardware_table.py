"""The table of the hardware study."""

from __future__ import annotations

from rich.console import RenderableType

from flexbase.cli.show import table, title
from flexbase.study.hardware import HardwareStudy


def tables(found: HardwareStudy) -> list[RenderableType]:
    """A line a method and setting, and how far the shares may be trusted."""
    rows = [
        [
            row.method,
            f"{row.rate_hz / 1e3:g} kHz x{row.gain_scale:g}",
            *(f"{100.0 * share:.0f}" for share in (row.stable_share, row.margin_share, row.perturbed_share)),
            f"{100.0 * row.complete_share:.0f}",
            "none" if row.tip_stiffness is None else f"{row.tip_stiffness:.2g}",
        ]
        for row in found.rows
    ]
    heading = ["method", "rate, gains", "stable", "margin", "changed", "all", "stiffness N/m"]
    said = f"  Shares of {found.rows[0].poses} poses in percent; half-width of the 95 % intervals up to "
    widest = max(high - low for row in found.rows for low, high in (row.stable_interval, row.complete_interval))
    return [
        title(found.robot, "which controllers run"),
        "",
        table(heading, rows, words=(0, 1)),
        said + f"{50 * widest:.0f}.",
    ]
