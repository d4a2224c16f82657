"""A sweep over one axis: a panel a measure, a curve a mode, stretches without a value hatched."""

from __future__ import annotations

from itertools import groupby

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.report.maps.plane_maps import finish, labelled, raised
from flexbase.report.maps.signs import PATTERN, UNKNOWN, face
from flexbase.report.style import BLUE, GREEN, GREY, HATCH, ORANGE, PURPLE, RED, SKY, new_figure
from flexbase.sweeps.answers.chart import Chart, Layer

COLOURS = (BLUE, RED, GREEN, ORANGE, PURPLE, SKY)
COLUMNS = 3


def draw_curves(chart: Chart) -> Figure:
    """Every measure against the axis; a circle where it is zero."""
    panels = [list(group) for _, group in groupby(chart.layers, lambda layer: layer.name)]
    columns = min(len(panels), COLUMNS)
    rows = -(-len(panels) // columns)
    figure = new_figure(4.4 * columns + 0.6, 3.1 * rows + 0.9)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for ax in axes[len(panels) :]:
        ax.set_axis_off()
    for ax, layers in zip(axes, panels, strict=False):
        _panel(ax, chart, layers)
    finish(figure, chart)
    return figure


def zero_crossings(x: Array, layer: Layer) -> Array:
    """Where a layer of shape (cells,) is zero, linear between cells."""
    if layer.zeros is None:
        return np.empty(0)
    left, right = layer.zeros[:-1], layer.zeros[1:]
    found = np.flatnonzero((left < 0.0) & (right > 0.0) | (left > 0.0) & (right < 0.0))
    share = left[found] / (left[found] - right[found])
    return np.asarray(x[found] + share * (x[found + 1] - x[found]))


def runs(x: Array, where: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Stretches of marked cells, half a cell beyond their middles but not beyond the ends."""
    edges = np.concatenate([x[:1], 0.5 * (x[1:] + x[:-1]), x[-1:]])
    steps = np.diff(np.pad(where, 1).astype(int))
    return [
        (float(edges[a]), float(edges[b])) for a, b in zip(*(np.flatnonzero(steps == s) for s in (1, -1)), strict=True)
    ]


def _panel(ax: Axes, chart: Chart, layers: list[Layer]) -> None:
    axis, first = chart.axes[0], layers[0]
    x = axis.values
    for code, cells in chart.missing(first).items():
        for begin, end in runs(x, cells):
            ax.axvspan(begin, end, facecolor=face(code), edgecolor=HATCH, hatch=PATTERN.get(code, UNKNOWN), linewidth=0)
    if any(layer.known.size for layer in layers):
        for colour, layer in zip(COLOURS, layers, strict=False):
            label = layer.title.removeprefix(f"{layer.name}, ")
            marker = "." if np.isfinite(layer.values).sum() < 40 else ""
            ax.plot(x, layer.finite, color=colour, marker=marker, label=label)
            zeros = zero_crossings(x, layer)
            if zeros.size:
                ax.plot(zeros, np.zeros_like(zeros), "o", color=colour, markerfacecolor="white", zorder=3)
        if first.zero_is:
            ax.axhline(0.0, color=GREY, linewidth=0.8, zorder=0.5)
        if len(layers) > 1:
            ax.legend(loc="best")
    else:
        ax.text(0.5, 0.5, "no cell has a value", transform=ax.transAxes, ha="center", backgroundcolor="white")
        ax.set_yticks([])
    ax.set_title(f"{first.name}\nzero: {first.zero_is}" if first.zero_is else first.name, loc="left", fontsize=9)
    ax.set_xlim(float(x[0]), float(x[-1]))
    ax.set_xlabel(labelled(axis))
    ax.set_ylabel(first.name if first.unit == "1" else f"{first.name} [{raised(first.unit)}]")
