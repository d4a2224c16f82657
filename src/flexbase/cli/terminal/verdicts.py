"""Verdicts on sampled controllers side by side, as a table."""

from __future__ import annotations

from rich.console import RenderableType

from flexbase.cli.terminal.show import facts, table, title
from flexbase.sampled.judged import GOOD_MARGIN
from flexbase.sampled.verdict import HardwareVerdict
from flexbase.sheets.numbers import kilo, number
from flexbase.study.running.comparison import Comparison

COLUMNS = (
    "method",
    "radius",
    "margins",
    "delay lag\n[ms]",
    "worst\nradius",
    "stiff\n[kN/m]",
    "tip\n[%]",
    "tau\n[ms]",
)
NO_TORQUE = """  A robot that takes positions only cannot run these laws: they are torques. It
  can run admittance, well below the bandwidth of its own position loop."""
LEGEND = f"""  * safe: stable, disk margins of {GOOD_MARGIN:g} at torques and sensors, and on all
  changed robots stable. radius: spectral, a sample; below 1 it settles; worst:
  when changed. delay, lag: what all torques bear beyond their own, -: no limit.
  stiff: of the tip, at rest and at its worst frequency; rotations in kN m/rad.
  tip: of a constant tip error that the joints do not show, what is taken away."""


def tables(found: Comparison) -> list[RenderableType]:
    """A row a method, and why some have none."""
    judged = [one.verdict for one in found.contenders if one.verdict is not None]
    rows = [_row(one) for one in judged]
    reasons = [(one.method, one.reason) for one in found.contenders if one.verdict is None]
    radii = [
        (
            one.method,
            f"{number(one.algebraic_loop_radius, 4)}; a delay a joint {number(one.algebraic_loop_radius_per_joint, 4)}",
        )
        for one in judged
        if one.algebraic_loop_radius is not None
    ]
    failing = [(one.method, ", ".join(one.failed)) for one in judged if one.failed and one.stable]
    said: list[RenderableType] = [title(found.robot, "as it runs"), "", facts([("loop", found.sensing.summary())])]
    said += [table(COLUMNS, rows), LEGEND]
    for heading, what in (("algebraic loop of E", radii), ("fails when changed", failing), ("no controller", reasons)):
        said += ["", f"  {heading}:", facts(what)] if what else []
    return [*said, "", NO_TORQUE]


def _row(one: HardwareVerdict) -> list[str]:
    margins = f"{one.disk_margin_torque:.2f} {one.disk_margin_sensor:.2f}" if one.stable else "-"
    bears = f"{_milli(one.delay_margin_s)} {_milli(one.lag_margin_s)}" if one.stable else "-"
    rest = ["-", "-", "-"]
    if one.tip_stiffness is not None and one.dynamic_stiffness is not None:
        rest = [
            f"{kilo(one.tip_stiffness)} {kilo(one.dynamic_stiffness)}",
            f"{100.0 * (one.tip_correction or 0.0):.0f}",
            _short(1e3 * (one.time_constant_s or 0.0)),
        ]
    mark = "*" if one.safe else ""
    return [f"{one.method}{mark}", f"{one.spectral_radius:.4f}", margins, bears, f"{one.worst_radius:.4f}", *rest]


def _short(value: float) -> str:
    return f"{value:.0f}" if value >= 100.0 else f"{value:.1f}"


def _milli(seconds: float | None) -> str:
    return "-" if seconds is None else f"{1e3 * seconds:.2f}"
