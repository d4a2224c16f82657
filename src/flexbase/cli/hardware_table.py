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
            f"{row.rate_hz / 1e3:g}k x{row.gain_scale:g}",
            *(f"{100.0 * share:.0f}" for share in (row.stable_share, row.margin_share, row.perturbed_share)),
            f"{100.0 * row.complete_share:.0f}",
            "" if row.tip_stiffness is None else f"{1e-3 * row.tip_stiffness:.2g}",
            "" if row.tip_correction is None else f"{100.0 * row.tip_correction:.0f}",
            "" if row.time_constant_s is None else f"{1e3 * row.time_constant_s:.0f}",
        ]
        for row in found.rows
    ]
    heading = ("method", "rate\ngains", "stable\n[%]", "margin\n[%]", "changed\n[%]", "all\n[%]")
    widest = max(high - low for row in found.rows for low, high in (row.stable_interval, row.complete_interval))
    return [
        title(found.robot, "which controllers run"),
        "",
        table([*heading, "stiff\n[kN/m]", "tip\n[%]", "tau\n[ms]"], rows, words=(0, 1)),
        f"  Shares of {found.rows[0].poses} poses; half-width of the 95 % intervals up to {50 * widest:.0f} %.\n"
        "  Medians where stable: static stiffness at the tip; tip, of a constant tip error\n"
        "  that the joints do not show, what is taken away; tau, of the slowest motion.",
    ]
