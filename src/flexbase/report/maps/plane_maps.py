"""A sweep over two axes, or planes of one over three: a panel a measure and mode, hatched where there is no value."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from flexbase.checks import Array
from flexbase.report.maps.signs import PATTERN, UNKNOWN, Scale, face, outlines, scale_of, zero_paths
from flexbase.report.style import BLUE, HATCH, INK, new_figure
from flexbase.sweeps.answers.chart import Chart, Layer
from flexbase.sweeps.cells.axis import Axis

COLUMNS = 3
PANEL = (4.4, 4.0)  # inch, with the colour bar
SLICE = (3.0, 2.9)


def draw_plane(chart: Chart) -> Figure:
    """A panel a layer."""
    columns = min(len(chart.layers), COLUMNS)
    rows = -(-len(chart.layers) // columns)
    figure = new_figure(PANEL[0] * columns + 0.5, PANEL[1] * rows + 0.7)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for ax in axes[len(chart.layers) :]:
        ax.set_axis_off()
    zeros = 0
    for ax, layer in zip(axes, chart.layers, strict=False):
        scale = scale_of(layer)
        zeros += panel(ax, chart, layer, scale)
        ax.set_title(titled(layer), loc="left", fontsize=9)
        if scale is not None:
            _colour_bar(figure, [ax], layer, scale)
    finish(figure, chart, zeros=zeros)
    return figure


def draw_slices(chart: Chart) -> Figure:
    """A panel a layer and value of the third axis; panels of a layer share their colours."""
    planes = list(chart.slices())
    alone = len(chart.layers) == 1
    columns = min(len(planes), 2 if len(planes) == 4 else COLUMNS) if alone else len(planes)
    rows = -(-len(planes) // columns) * len(chart.layers)
    figure = new_figure(SLICE[0] * columns + 1.1, SLICE[1] * rows + 0.9)
    axes = figure.subplots(rows, columns, squeeze=False)
    zeros = 0
    for row, layer in zip(np.split(axes, len(chart.layers)), chart.layers, strict=True):
        scale = scale_of(layer)
        cells = row.ravel()
        for ax in cells[len(planes) :]:
            ax.set_axis_off()
        for ax, (where, plane) in zip(cells, planes, strict=False):
            zeros += panel(ax, plane, plane.layers[chart.layers.index(layer)], scale)
            ax.set_title(where, loc="left", fontsize=9)
        if not alone:
            cells[0].set_title(f"{layer.title}\n{planes[0][0]}", loc="left", fontsize=9)
        if scale is not None:
            _colour_bar(figure, list(cells), layer, scale)
        for i, ax in enumerate(cells[: len(planes)]):
            _label_outer(ax, left=i % columns == 0, below=i + columns >= len(planes))
    finish(figure, chart, titled(chart.layers[0]).replace("\n", ", ") if alone else "", zeros)
    return figure


def panel(ax: Axes, chart: Chart, layer: Layer, scale: Scale | None) -> int:
    """A layer of a plane: hatches, colours, thin lines of equal value, and thick ones at zero; how many of those."""
    first, second = chart.axes
    x, y = first.values, second.values
    zeros = zero_paths(x, y, layer)
    for code, cells in chart.missing(layer).items():
        for region in outlines(x, y, cells):
            hatch = PATTERN.get(code, UNKNOWN)
            ax.add_patch(PathPatch(_path(region), facecolor=face(code), edgecolor=HATCH, hatch=hatch, linewidth=0))
    if scale is not None and layer.known.size:
        norm = Normalize(scale.low, scale.high)
        ax.pcolormesh(x, y, layer.finite, norm=norm, cmap=scale.colours, shading="nearest", rasterized=True)
        _levels(ax, x, y, layer, scale)
        for line in zeros:
            ax.plot(*line.T, color=BLUE, linewidth=2.0, solid_capstyle="butt")
    if scale is None or not layer.known.any():
        ax.text(0.5, 0.5, empty_words(layer), transform=ax.transAxes, ha="center", backgroundcolor="white")
    if first.unit == second.unit == "m":
        ax.set_aspect("equal")
    ax.set_xlim(float(x[0]), float(x[-1]))
    ax.set_ylim(float(y[0]), float(y[-1]))
    ax.set_xlabel(labelled(first))
    ax.set_ylabel(labelled(second))
    return len(zeros)


def finish(figure: Figure, chart: Chart, more: str = "", zeros: int = 0) -> None:
    """The heading, and below it what the signs mean."""
    if isinstance(engine := figure.get_layout_engine(), ConstrainedLayoutEngine):
        engine.set(h_pad=0.09)
    figure.suptitle(f"{chart.heading}: {more}" if more else chart.heading, x=0.01, ha="left", fontsize=10)
    found = {code for layer in chart.layers for code in chart.missing(layer)}
    handles = [*_zero_key(zeros), *keys(chart, found)]
    if handles:
        figure.legend(
            handles=handles,
            loc="outside lower center",
            ncols=min(len(handles), max(1, int(figure.get_figwidth() / 2.4))),
        )


def keys(chart: Chart, codes: Collection[int]) -> list[Patch]:
    """Patches for a legend: the hatch of each status and what it means."""
    return [
        Patch(facecolor=face(code), edgecolor=HATCH, hatch=PATTERN[code], linewidth=0, label=meaning)
        for code, meaning in chart.meanings.items()
        if code in codes and code in PATTERN
    ]


def _zero_key(zeros: int) -> list[Line2D]:
    return [Line2D([], [], color=BLUE, linewidth=2.0, label="zero")] if zeros else []


def empty_words(layer: Layer) -> str:
    """What a panel says that has nothing to show."""
    return "zero in every cell" if layer.known.size else "no cell has a value"


def labelled(axis: Axis) -> str:
    """An axis' name and unit."""
    return axis.name if axis.unit == "1" else f"{axis.name} [{raised(axis.unit)}]"


def named(layer: Layer) -> str:
    """A layer's title and unit."""
    return layer.title if layer.unit == "1" else f"{layer.title} [{raised(layer.unit)}]"


def titled(layer: Layer) -> str:
    """A layer's title and what its zero means."""
    return f"{layer.title}\nzero: {layer.zero_is}" if layer.zero_is else layer.title


def raised(unit: str) -> str:
    """A unit with its exponents raised."""
    return re.sub(r"\^(-?\w+)", r"$^{\1}$", unit)


def _label_outer(ax: Axes, left: bool, below: bool) -> None:
    """Numbers and names at the border of a block of panels only."""
    ax.tick_params(labelleft=left, labelbottom=below)
    ax.set_ylabel(ax.get_ylabel() if left else "")
    ax.set_xlabel(ax.get_xlabel() if below else "")


def _colour_bar(figure: Figure, axes: Sequence[Axes], layer: Layer, scale: Scale) -> None:
    extend = {(True, True): "both", (True, False): "min", (False, True): "max"}.get(
        (scale.below, scale.above), "neither"
    )
    colours = ScalarMappable(Normalize(scale.low, scale.high), scale.colours)
    figure.colorbar(colours, ax=axes, extend=extend, label=named(layer), aspect=28, pad=0.02, shrink=0.9)


def _levels(ax: Axes, x: Array, y: Array, layer: Layer, scale: Scale) -> None:
    levels = np.linspace(scale.low, scale.high, 17)[1:-1]
    inside = levels[(levels > layer.known.min()) & (levels < layer.known.max())]
    if inside.size and min(layer.values.shape) > 1:
        ax.contour(x, y, layer.finite, levels=inside, colors=[INK], linewidths=0.35, alpha=0.6, linestyles="solid")


def _path(region: Sequence[Array]) -> Path:
    return Path.make_compound_path(*(Path(line, closed=True) for line in region))
