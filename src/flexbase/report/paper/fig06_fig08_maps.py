"""Fig. 6 and 8: w_1 as a surface and as contour lines."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from flexbase.report.paper import ring
from flexbase.report.style import new_figure, styled
from flexbase.study.paper import RobustnessMap

LABELS_WITHOUT = ((0.2, 0.31), (0.25, -0.37), (0.15, 0.37), (0.56, 0.03))  # near the lines w = -0.03 and -0.09
LABELS_WITH = ((-0.22, 0.12), (0.45, -0.31), (0.06, 0.33), (0.25, -0.42))


@styled()
def surface(chart: RobustnessMap) -> Figure:
    """Fig. 6a, 8a: w_1 as a surface over the workspace."""
    figure = new_figure(5.8, 4.4)
    ax = figure.add_subplot(projection="3d", computed_zorder=False)
    ring.draw_surface(ax, chart)
    ax.view_init(elev=38.0, azim=-62.0)
    ax.set_box_aspect((1.0, 1.0, 0.55), zoom=1.12)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.set_zlabel(f"$w_1$ [{ring.UNIT}]", labelpad=4)
    ax.set_zticks(np.arange(-4, 1) * 0.1)
    _colour_bar(figure, ax, "colours end at −0.30, surface at −0.45", shrink=0.7, pad=0.1)
    keep = ring.legend_entries(chart, point=False)
    handles = [entry for entry in keep if entry.get_label() not in ("arm singular", "out of reach")]
    figure.legend(handles=handles, loc="outside lower center", ncols=2)
    return figure


@styled()
def contours(chart: RobustnessMap) -> Figure:
    """Fig. 6b, 8b: w_1 as contour lines."""
    figure = new_figure(5.8, 5.4)
    ax = figure.add_subplot()
    ring.draw_map(ax, chart, LABELS_WITH if chart.compensated else LABELS_WITHOUT)
    _colour_bar(figure, ax, "colours and lines end at −0.30", shrink=0.9, pad=0.02)
    figure.legend(handles=ring.legend_entries(chart), loc="outside lower center", ncols=2)
    return figure


def _colour_bar(figure: Figure, ax: Axes, remark: str, *, shrink: float, pad: float) -> None:
    cmap, norm = ring.colours()
    bar = figure.colorbar(ScalarMappable(norm, cmap), ax=ax, extend="min", shrink=shrink, pad=pad, aspect=28)
    bar.set_label(f"$w_1$ [{ring.UNIT}] ({remark})")
