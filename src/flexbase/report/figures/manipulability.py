"""Manipulability before and after a compensator: ellipses in a plane, semi-axes otherwise."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from flexbase.measures.manipulability import Manipulability
from flexbase.report.style import BLUE, GREY, INK, new_figure

UNITS = {"force": r"tip acceleration per force [kg$^{-1}$]", "torque": r"tip acceleration per torque [m/(N m s$^2$)]"}


def draw_manipulability(result: Manipulability) -> Figure:
    """Two ellipses with their longest axes; for one or three and more task rows, the semi-axes as bars."""
    return _ellipses(result) if len(result.original.semi_axes) == 2 else _bars(result)


def _ellipses(result: Manipulability) -> Figure:
    figure = new_figure(4.6, 4.6)
    ax = figure.add_subplot()
    styles = ((result.original, INK, (0, (4, 2)), "original"), (result.compensated, BLUE, "-", "compensated"))
    for ellipsoid, color, line, name in styles:
        ax.plot(*ellipsoid.boundary().T, color=color, linestyle=line, label=name)
        tip = ellipsoid.semi_axes[0] * ellipsoid.directions[:, 0]
        ax.plot(*np.array([-tip, tip]).T, color=color, linestyle=line, linewidth=0.6)
    unit = UNITS[result.original.convention]
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel(f"first task row, {unit}")
    ax.set_ylabel(f"second task row, {unit}")
    ax.axhline(0.0, color=GREY, linewidth=0.4, zorder=0)
    ax.axvline(0.0, color=GREY, linewidth=0.4, zorder=0)
    ax.set_title(
        f"turned by {np.degrees(result.rotation):.1f}°, area × {result.volume_ratio:.3f}".replace("-", "−"), loc="left"
    )
    ax.legend(loc="upper right")
    return figure


def _bars(result: Manipulability) -> Figure:
    figure = new_figure(4.8, 3.2)
    ax = figure.add_subplot()
    places = np.arange(1, len(result.original.semi_axes) + 1)
    ax.bar(places - 0.2, result.original.semi_axes, 0.36, color="white", edgecolor=INK, label="original")
    ax.bar(places + 0.2, result.compensated.semi_axes, 0.36, color=BLUE, edgecolor=BLUE, label="compensated")
    ax.set_xticks(places)
    ax.set_xlabel("semi-axis, longest first")
    ax.set_ylabel(f"acceleration per unit {result.original.convention} [SI]")
    ax.set_xlim(0.4, len(places) + 0.6)
    ax.set_title(f"volume × {result.volume_ratio:.3f}", loc="left")
    figure.legend(loc="outside lower center", ncols=2)
    return figure
