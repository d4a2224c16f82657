"""The table of the hardware study."""

from __future__ import annotations

from rich.console import RenderableType

from flexbase.cli.terminal.show import table, title
from flexbase.sheets.numbers import kilo
from flexbase.study.running.hardware_study import HardwareStudy, Row


def tables(found: HardwareStudy) -> list[RenderableType]:
    """A line a method and setting, and how far the shares may be trusted."""
    rows = [
        [
            row.method,
            f"{row.rate_hz / 1e3:g}k x{row.gain_scale:g}",
            *(f"{100.0 * share:.0f}" for share in (row.stable_share, row.margin_share, row.perturbed_share)),
            f"{100.0 * row.complete_share:.0f}",
            _stiffness(row),
            _shown(row, "tip_correction", 100.0),
            _shown(row, "time_constant_s", 1e3),
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
        "  Medians where stable: stiff, of the tip, at rest and at its worst frequency (of\n"
        "  a rotation in kN m/rad); tip, of a constant tip error that the joints do not\n"
        "  show, what is taken away; tau, of the slowest motion.",
    ]


def _shown(row: Row, name: str, times: float) -> str:
    value = row.medians[name]
    return "" if value is None else f"{times * value:.0f}"


def _stiffness(row: Row) -> str:
    at_rest, at_speed = row.medians["tip_stiffness"], row.medians["dynamic_stiffness"]
    return "" if at_rest is None or at_speed is None else f"{kilo(at_rest)} {kilo(at_speed)}"
