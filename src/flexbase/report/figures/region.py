"""The region around a pose in which one constant controller stays valid."""

from __future__ import annotations

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch

from flexbase.report.style import BLUE, INK, ORANGE, PALE, SKY, new_figure
from flexbase.study.running.region import MEANINGS, Region

COLOURS = (PALE, ORANGE, SKY, BLUE)  # by code; told apart in grey too


def draw_validity(found: Region) -> Figure:
    """Cells by their grade, the design tip, and the largest disks in which all cells are safe or stable."""
    figure = new_figure(5.2, 5.0)
    ax = figure.add_subplot()
    ax.pcolormesh(found.x, found.y, found.grade, cmap=ListedColormap(COLOURS), vmin=-0.5, vmax=3.5, shading="nearest")
    disks = [
        (found.safe_radius, Line2D([], [], color=INK, linestyle="-", linewidth=1.0, label="all safe within")),
        (found.stable_radius, Line2D([], [], color=INK, linestyle="--", linewidth=1.0, label="all stable within")),
    ]
    for radius, key in disks:
        if radius:
            circle = Circle(found.tip, radius, fill=False, color=INK, linestyle=key.get_linestyle(), linewidth=1.0)
            ax.add_patch(circle)
    ax.plot(*found.tip, "x", color=INK)
    half = 0.5 * (found.x[1] - found.x[0]), 0.5 * (found.y[1] - found.y[0])
    ax.set(
        xlim=(found.x[0] - half[0], found.x[-1] + half[0]),
        ylim=(found.y[0] - half[1], found.y[-1] + half[1]),
        xlabel=f"{found.rows[0]} [{found.units[0]}]",
        ylabel=f"{found.rows[1]} [{found.units[1]}]",
        aspect="equal" if found.units[0] == found.units[1] else "auto",
    )
    present = [code for code in MEANINGS if np.any(found.grade == code)]
    handles = [Patch(facecolor=COLOURS[code], edgecolor=INK, linewidth=0.5, label=MEANINGS[code]) for code in present]
    figure.legend(handles=[*handles, *(key for radius, key in disks if radius)], loc="outside lower center", ncols=2)
    ax.set_title(f"{found.robot}, method {found.method}: {found.what} made at the cross", loc="left")
    return figure
