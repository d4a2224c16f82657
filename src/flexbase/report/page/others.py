"""Panels of sweeps over one axis, and over samples."""

from __future__ import annotations

from itertools import groupby
from typing import Any

import numpy as np

from flexbase.report.maps.line_curves import COLOURS, runs, zero_crossings
from flexbase.report.maps.samples import BINS, middle, missing_words
from flexbase.report.maps.signs import scale_of
from flexbase.report.page.planes import Panel
from flexbase.report.page.traces import (
    area,
    colorscale,
    colour_bar,
    heading,
    labelled,
    layer_unit,
    layout,
    titled,
    unit_of,
)
from flexbase.report.style import BLUE, GREY, HATCH, SKY
from flexbase.sweeps.answers.chart import Chart, Layer

DOTS = 6000  # of a cloud: a browser draws so many without delay


def curve_panels(chart: Chart) -> list[Panel]:
    """A panel a measure, a curve a mode, circles at zeros, hatches where there is no value."""
    return [_curves(chart, list(group)) for _, group in groupby(chart.layers, lambda layer: layer.name)]


def _curves(chart: Chart, layers: list[Layer]) -> Panel:
    axis, first = chart.axes[0], layers[0]
    x = axis.values
    data: list[dict[str, Any]] = []
    for code, cells in chart.missing(first).items():
        for a, b in runs(x, cells):
            words = {"hoverinfo": "text", "hoveron": "fills", "text": chart.meanings[code], "yaxis": "y2"}
            data.append(area([a, b, b, a], [0.0, 0.0, 1.0, 1.0], code, **words))
    for colour, layer in zip(COLOURS, layers, strict=False):
        said = f"{axis.name} %{{x:.5g}} {unit_of(axis)}<br><b>{layer.title} %{{y:.5g}} {layer_unit(layer)}</b>"
        name = layer.title.removeprefix(f"{layer.name}, ")
        shared = {"type": "scatter", "name": name, "hovertemplate": said + "<extra></extra>"}
        data.append(
            {
                **shared,
                "mode": "lines",
                "x": x,
                "y": layer.finite,
                "line": {"color": colour, "width": 2, "simplify": False},
            }
        )
        zeros = zero_crossings(x, layer)
        ring = {"color": "white", "size": 9, "line": {"color": colour, "width": 2}}
        if zeros.size:
            data.append(
                {
                    **shared,
                    "mode": "markers",
                    "x": zeros,
                    "y": np.zeros_like(zeros),
                    "marker": ring,
                    "showlegend": False,
                }
            )
    across = {"title": {"text": labelled(axis)}, "range": [float(x[0]), float(x[-1])]}
    up = {
        "title": {"text": titled(first._replace(title=first.name))},
        "zeroline": bool(first.zero_is),
        "zerolinecolor": GREY,
    }
    hidden = {"overlaying": "y", "range": [0, 1], "visible": False, "fixedrange": True}
    legend = {"orientation": "h", "x": 1.0, "xanchor": "right", "y": 1.0, "yanchor": "bottom"}
    title = heading(first._replace(title=first.name))
    around = layout(title, across, up, yaxis2=hidden, legend=legend)
    return {"data": data, "layout": {**around, "showlegend": len(layers) > 1}}


def sample_panels(chart: Chart) -> list[Panel]:
    """A histogram a layer, and a cloud over the first two coordinates that were drawn."""
    panels = []
    for layer in chart.layers:
        panels.append(_histogram(chart, layer))
        if len(chart.drawn) > 1:
            panels.append(_cloud(chart, layer))
    return panels


def _histogram(chart: Chart, layer: Layer) -> Panel:
    data, shapes, words = [], [], missing_words(chart, layer).splitlines()
    if layer.known.size:
        counts, edges = np.histogram(layer.known, BINS, middle(layer))
        median = float(np.median(layer.known))
        said = f"{layer.title} %{{x:.5g}} {layer_unit(layer)}<br>%{{y:.3g}} % of samples<extra></extra>"
        data.append(
            {
                "type": "bar", "x": 0.5 * (edges[1:] + edges[:-1]), "y": 100.0 * counts / layer.values.size,
                "width": np.diff(edges), "marker": {"color": SKY}, "hovertemplate": said,
            }
        )  # fmt: skip
        shapes.append(
            {"type": "line", "x0": median, "x1": median, "y0": 0, "y1": 1, "yref": "paper", "line": {"color": BLUE}}
        )
        words.insert(0, f"median {median:.5g} {layer_unit(layer)}")
    up = {"title": {"text": "share of samples [%]"}, "rangemode": "tozero"}
    around = layout(heading(layer, *words), {"title": {"text": titled(layer)}}, up, shapes=shapes, bargap=0)
    return {"data": data, "layout": around}


def _cloud(chart: Chart, layer: Layer) -> Panel:
    first, second = chart.drawn[:2]
    x, y, values = (array[:DOTS] for array in (first.values, second.values, layer.finite))
    known, scale = np.isfinite(values), scale_of(layer)
    where = f"{first.name} %{{x:.5g}} {unit_of(first)}<br>{second.name} %{{y:.5g}} {unit_of(second)}<br>"
    data: list[dict[str, Any]] = []
    for code, cells in chart.missing(layer).items():
        cross = {"symbol": "x-thin", "size": 5, "line": {"color": HATCH, "width": 1}}
        text = where + chart.meanings[code] + "<extra></extra>"
        gaps = cells[:DOTS]
        data.append(
            {"type": "scatter", "mode": "markers", "x": x[gaps], "y": y[gaps], "marker": cross, "hovertemplate": text}
        )
    if scale is not None:
        marker = {
            "size": 5, "color": values[known].astype(np.float32), "cmin": scale.low, "cmax": scale.high,
            "colorscale": colorscale(scale), "colorbar": colour_bar(layer), "showscale": True,
        }  # fmt: skip
        text = where + f"<b>{layer.title} %{{marker.color:.5g}} {layer_unit(layer)}</b><extra></extra>"
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "x": x[known],
                "y": y[known],
                "marker": marker,
                "hovertemplate": text,
            }
        )
    said = [] if known.all() else ["crosses: no value that could be shown"]
    equal = {"scaleanchor": "x"} if first.unit == second.unit == "m" else {}
    across, up = {"title": {"text": labelled(first)}}, {"title": {"text": labelled(second)}, **equal}
    return {"data": data, "layout": layout(heading(layer, *said), across, up)}
