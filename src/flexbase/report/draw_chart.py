"""A map of measures over two axes: one panel a measure and mode, cells without a value hatched by their reason."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from flexbase.checks import Array
from flexbase.measures import MEASURES
from flexbase.report.style import BLUE, DIVERGING, HATCH, INK, new_figure
from flexbase.sweep.chart import Chart, chart_of
from flexbase.sweep.status import INDEFINITE, INFEASIBLE, SINGULAR, STATUS, UNREACHABLE

PATTERN = {UNREACHABLE: "///", SINGULAR: "...", INDEFINITE: "xxx", INFEASIBLE: "|||"}
TAIL = 4.0  # percent of the cells at either end that the colours may leave out


class Layer(NamedTuple):
    """One panel: the name over it, its unit, values of shape (rows, columns), and what its zero means, if anything.

    zero_line : where the values only touch zero, a companion that changes its sign there
    """

    title: str
    unit: str
    values: Array
    zero_is: str | None
    zero_line: Array | None = None


def draw_dataset(dataset: Any) -> Figure:
    """All measures of a sweep over two axes. Raises InputError for another number of axes."""
    return draw_chart(chart_of(dataset))


def draw_chart(chart: Chart) -> Figure:
    """All measures of a chart; colours span the middle 92 percent of the cells, about zero where that has a meaning."""
    layers = _layers(chart)
    columns = min(len(layers), 3)
    rows = -(-len(layers) // columns)
    figure = new_figure(4.9 * columns, 4.3 * rows + 0.3)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for ax in axes[len(layers) :]:
        ax.set_axis_off()
    for ax, layer in zip(axes, layers, strict=False):
        _panel(figure, ax, chart, layer)
    missing = [code for code in PATTERN if chart.count(code)]
    if missing:
        signs = [
            Patch(facecolor="white", edgecolor=HATCH, hatch=PATTERN[code], linewidth=0, label=STATUS[code])
            for code in missing
        ]
        figure.legend(handles=signs, loc="outside lower center", ncols=len(signs))
    return figure


def _layers(chart: Chart) -> list[Layer]:
    layers = []
    for name, values in chart.values.items():
        known = MEASURES[name]
        if values.ndim == 3:
            several = values.shape[-1] > 1
            layers += [
                Layer(
                    f"{name}{f', mode {i + 1}' if several else ''}",
                    known.unit,
                    values[..., i],
                    known.zero_is,
                    chart.zero_lines[name][..., i] if name in chart.zero_lines else None,
                )
                for i in range(values.shape[-1])
            ]
        else:
            layers.append(Layer(name, known.unit, values, known.zero_is))
    return layers


def _panel(figure: Figure, ax: Axes, chart: Chart, layer: Layer) -> None:
    first, second = chart.axes
    x, y = first.values, second.values
    for code, pattern in PATTERN.items():
        _hatch(ax, x, y, chart.status == code, pattern)
    known = layer.values[np.isfinite(layer.values)]
    ax.set_title(_title(chart, layer), loc="left", fontsize=9)
    if known.size:
        norm, cmap = _colours(known, layer)
        picture = ax.pcolormesh(x, y, layer.values, norm=norm, cmap=cmap, shading="nearest", rasterized=True)
        low, high = known.min() < (norm.vmin or 0.0), known.max() > (norm.vmax or 0.0)
        extend = "both" if low and high else "min" if low else "max" if high else "neither"
        label = re.sub(r"\^(-?\w+)", r"$^{\1}$", f"{layer.title} [{layer.unit}]") if layer.unit != "1" else layer.title
        figure.colorbar(picture, ax=ax, extend=extend, label=label, aspect=28, pad=0.02, shrink=0.9)
        _lines(ax, x, y, layer, norm)
    else:
        ax.text(0.5, 0.5, "no cell has a value", transform=ax.transAxes, ha="center", backgroundcolor="white")
    if first.unit == second.unit == "m":
        ax.set_aspect("equal")
    ax.set_xlim(float(x[0]), float(x[-1]))
    ax.set_ylim(float(y[0]), float(y[-1]))
    ax.set_xlabel(f"{first.name} [{first.unit}]")
    ax.set_ylabel(f"{second.name} [{second.unit}]")


def _title(chart: Chart, layer: Layer) -> str:
    name = f"{chart.robot}: {layer.title}{', compensated' if chart.compensated else ''}"
    return name + (f"\nzero: {layer.zero_is}" if layer.zero_is else "")


def _colours(known: Array, layer: Layer) -> tuple[Normalize, str | Colormap]:
    """Diverging about zero where the measure's zero means something, or the half of it that occurs; else sequential."""
    low, high = (float(bound) for bound in np.percentile(known, [TAIL, 100.0 - TAIL]))
    if layer.zero_is is None:
        return Normalize(low, high if high > low else low + 1.0), "viridis"
    size = max(abs(low), abs(high)) or 1.0
    full = ScalarMappable(Normalize(-1.0, 1.0), DIVERGING).get_cmap()
    if known.max() <= 0.0:
        return Normalize(-size, 0.0), LinearSegmentedColormap.from_list("below", full(np.linspace(0.0, 0.5, 128)))
    if known.min() >= 0.0:
        return Normalize(0.0, size), LinearSegmentedColormap.from_list("above", full(np.linspace(0.5, 1.0, 128)))
    return Normalize(-size, size), full


def _lines(ax: Axes, x: Array, y: Array, layer: Layer, norm: Normalize) -> None:
    levels = np.linspace(norm.vmin or 0.0, norm.vmax or 0.0, 17)[1:-1]
    low, high = np.nanmin(layer.values), np.nanmax(layer.values)
    inside = levels[(levels > low) & (levels < high)]
    if inside.size:
        ax.contour(x, y, layer.values, levels=inside, colors=[INK], linewidths=0.35, alpha=0.6, linestyles="solid")
    if layer.zero_line is not None:
        near = np.where(np.abs(layer.zero_line) < np.pi / 2.0, layer.zero_line, np.nan)  # not where it jumps at pi
        if np.nanmin(near, initial=0.0) < 0.0 < np.nanmax(near, initial=0.0):
            ax.contour(x, y, near, levels=[0.0], colors=[BLUE], linewidths=2.0)
    elif layer.zero_is is not None and low < 0.0 < high:
        ax.contour(x, y, layer.values, levels=[0.0], colors=[BLUE], linewidths=2.0)


def _hatch(ax: Axes, x: Array, y: Array, where: Array, pattern: str) -> None:
    if where.any():
        ax.contourf(x, y, where.astype(float), levels=[0.5, 1.5], colors=["white"], hatches=[pattern])
