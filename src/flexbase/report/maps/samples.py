"""A sweep over samples: of each measure and mode its distribution, and its values over the first two coordinates."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from flexbase.report.maps.plane_maps import labelled, named, titled
from flexbase.report.maps.signs import Scale, scale_of
from flexbase.report.style import BLUE, GREY, HATCH, PALE, SKY, new_figure
from flexbase.sweeps.answers.chart import Chart, Layer

DOTS = 20_000  # of a cloud: more hide each other
BINS = 60


def draw_samples(chart: Chart) -> Figure:
    """A row a layer: a histogram, and a cloud where two coordinates or more were drawn."""
    clouds = len(chart.drawn) > 1
    rows, columns = len(chart.layers), 1 + clouds
    figure = new_figure(4.6 * columns + 0.4, 3.3 * rows + 0.5)
    axes = figure.subplots(rows, columns, squeeze=False)
    for row, layer in zip(axes, chart.layers, strict=True):
        scale = scale_of(layer)
        _histogram(row[0], chart, layer, scale)
        if clouds:
            _cloud(figure, row[1], chart, layer, scale)
    figure.suptitle(f"{chart.heading}: {chart.status.size} samples", x=0.01, ha="left", fontsize=10)
    return figure


def middle(layer: Layer) -> tuple[float, float]:
    """The span of a histogram: all but the outermost half percent at either end, where that is far away."""
    low, high = np.percentile(layer.known, [0.5, 99.5])
    least, most = float(layer.known.min()), float(layer.known.max())
    width = float(high - low)
    low, high = (max(least, low - 0.2 * width), min(most, high + 0.2 * width)) if width > 0.0 else (least, most)
    return (float(low), float(high)) if high > low else (low - 0.5, high + 0.5)


def missing_words(chart: Chart, layer: Layer) -> str:
    """How many samples have no value, and why, a line each."""
    gaps = chart.missing(layer).items()
    return "\n".join(f"{np.count_nonzero(cells)} not shown: {chart.meanings[code]}" for code, cells in gaps)


def _histogram(ax: Axes, chart: Chart, layer: Layer, scale: Scale | None) -> None:
    ax.set_title(titled(layer), loc="left", fontsize=9)
    if scale is None:
        ax.text(0.5, 0.5, "no sample has a value", transform=ax.transAxes, ha="center")
    else:
        low, high = middle(layer)
        shares = np.full(layer.known.size, 100.0 / layer.values.size)
        ax.hist(layer.known, bins=BINS, range=(low, high), weights=shares, color=SKY, edgecolor="white", linewidth=0.3)
        median = float(np.median(layer.known))
        ax.axvline(median, color=BLUE, linewidth=1.2, label=f"median {median:.4g}")
        outside = int(np.count_nonzero((layer.known < low) | (layer.known > high)))
        handles, labels = ax.get_legend_handles_labels()
        said = [f"{outside} samples lie beyond"] if outside else []
        said += missing_words(chart, layer).splitlines()
        blank = [ax.plot([], [], " ")[0] for _ in said]
        ax.legend([*handles, *blank], [*labels, *said], loc="best", handlelength=1.2)
        ax.set_xlim(low, high)
        ax.margins(y=0.25)
    ax.set_xlabel(named(layer))
    ax.set_ylabel("share of samples [%]")


def _cloud(figure: Figure, ax: Axes, chart: Chart, layer: Layer, scale: Scale | None) -> None:
    first, second = chart.drawn[:2]
    chosen = slice(0, DOTS)
    x, y, values = first.values[chosen], second.values[chosen], layer.finite[chosen]
    gaps = ~np.isfinite(values)
    ax.plot(x[gaps], y[gaps], "x", color=HATCH, markersize=3.0, markeredgewidth=0.6, zorder=1)
    if scale is not None:
        norm = Normalize(scale.low, scale.high)
        size = float(np.clip(2e4 / max(len(x), 1), 1.0, 20.0))
        dots = ax.scatter(
            x[~gaps], y[~gaps], size, values[~gaps], norm=norm, cmap=scale.colours, edgecolors=PALE, linewidths=0.15
        )
        dots.set_rasterized(True)
        extend = {(True, True): "both", (True, False): "min", (False, True): "max"}
        figure.colorbar(
            dots,
            ax=ax,
            label=named(layer),
            aspect=28,
            pad=0.02,
            extend=extend.get((scale.below, scale.above), "neither"),
        )
    if gaps.any():
        ax.set_title("crosses: no value", loc="right", fontsize=8, color=GREY)
    if first.unit == second.unit == "m":
        ax.set_aspect("equal")
    ax.set_xlabel(labelled(first))
    ax.set_ylabel(labelled(second))
