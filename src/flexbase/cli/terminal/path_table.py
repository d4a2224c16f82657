"""Verdicts on the sampled loop along a path, a line a tip."""

from __future__ import annotations

import math
from typing import Any

from flexbase.sheets.numbers import kilo, number

HEADS = ("tip", "", "radius", "margins", "worst\nradius", "stiff\n[kN/m]", "tip\n[%]", "tau\n[ms]")


def path_row(row: dict[str, Any]) -> list[str]:
    """A tip, what became of it where it is not ok, and the figures of its verdict as `flexbase hardware` shows them."""
    place = ", ".join(number(x, 4) for x in row["tip"])
    head = [place, "" if row["status"] == "ok" else row["status"]]
    if math.isnan(row["spectral_radius"]):
        return [*head, *["-"] * (len(HEADS) - len(head))]
    radii = f"{row['spectral_radius']:.4f}", f"{row['worst_radius']:.4f}"
    if math.isnan(row["tip_stiffness"]):
        return [*head, radii[0], "-", radii[1], "-", "-", "-"]
    return [
        *head,
        radii[0],
        f"{row['disk_margin_torque']:.2f} {row['disk_margin_sensor']:.2f}",
        radii[1],
        f"{kilo(row['tip_stiffness'])} {kilo(row['dynamic_stiffness'])}",
        f"{100.0 * row['tip_correction']:.0f}",
        f"{1e3 * row['time_constant_s']:.1f}",
    ]
