"""What the panels of a page are made of: plotly traces and layouts as plain dictionaries."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.report.maps.signs import Scale, face, outlines, zero_paths
from flexbase.report.style import BLUE, HATCH, INK, PALE
from flexbase.sweeps.answers.chart import INFINITE, Chart, Layer
from flexbase.sweeps.cells.axis import Axis
from flexbase.sweeps.engine.status import GAINED, INDEFINITE, INFEASIBLE, LOST, SINGULAR, UNREACHABLE, UNSTABLE

Trace = dict[str, Any]
SHAPES = {
    UNREACHABLE: "/",
    SINGULAR: ".",
    INDEFINITE: "x",
    INFEASIBLE: "|",
    LOST: "\\",
    GAINED: "+",
    UNSTABLE: "-",
    INFINITE: "",
}
GAP = 16  # added to the status of a cell that has no value
CLEAR = [[0.0, "rgba(0,0,0,0)"], [1.0, "rgba(0,0,0,0)"]]
FONT = {"family": "DejaVu Sans, Verdana, sans-serif", "size": 13, "color": INK}


def plane_traces(chart: Chart, layer: Layer, scale: Scale | None) -> list[Trace]:
    """Colours, cells without a value (invisible, for the pointer), hatched regions, and the zero line.

    The second holds `codes`, a status for each cell, which the page turns into words when it opens.
    """
    (first, second), values = chart.axes, layer.finite.astype(np.float32)
    x, y = first.values, second.values
    where = f"{first.name} %{{x:.5g}} {unit_of(first)}<br>{second.name} %{{y:.5g}} {unit_of(second)}<br>"
    codes = np.where(np.isinf(layer.values), INFINITE, chart.status) + GAP * np.isnan(values)
    shared = {"type": "heatmap", "x": x, "y": y}
    value = f"<b>{layer.title} %{{z:.5g}} {layer_unit(layer)}</b><br>%{{text}}<extra></extra>"
    traces: list[Trace] = [
        {**shared, "z": values, "hoverongaps": False, "hovertemplate": where + value, **_colours(layer, scale)},
        {**shared, "codes": codes.astype(np.int8), "colorscale": CLEAR, "showscale": False, "hoverongaps": False}
        | {"hovertemplate": where + "%{text}<extra></extra>"},
    ]
    for code, cells in chart.missing(layer).items():
        lines = [line for region in outlines(x, y, cells) for line in region]
        traces.append(_area(lines, code))
    if zeros := zero_paths(x, y, layer):
        rows, columns = _joined(zeros)
        line = {"color": BLUE, "width": 3}
        traces.append(
            {"type": "scatter", "mode": "lines", "x": rows, "y": columns, "line": line, "hoverinfo": "skip"}
            | {"showlegend": False, "name": "zero"}
        )
    return traces


def area(x: Sequence[float] | Array, y: Sequence[float] | Array, code: int, **more: Any) -> Trace:
    """A hatched polygon in the sign of a status."""
    pattern = {"shape": SHAPES.get(code, ""), "fgcolor": HATCH, "bgcolor": face(code), "size": 7, "solidity": 0.15}
    line = {"width": 0, "color": HATCH}
    return {
        "type": "scatter", "mode": "lines", "x": x, "y": y, "fill": "toself", "fillpattern": pattern, "line": line,
        "fillcolor": face(code), "hoverinfo": "skip", "showlegend": False, "name": f"status {code}", **more,
    }  # fmt: skip


def _area(lines: Sequence[Array], code: int) -> Trace:
    return area(*_joined(lines), code)


def _joined(lines: Sequence[Array]) -> tuple[Array, Array]:
    """Lines in one, NaN between them."""
    parts = [part for line in lines for part in (line, np.full((1, 2), np.nan))][:-1]
    x, y = np.concatenate(parts).astype(np.float32).T
    return x, y


def _colours(layer: Layer, scale: Scale | None) -> Trace:
    if scale is None:
        return {"showscale": False}
    return {"zmin": scale.low, "zmax": scale.high, "colorscale": colorscale(scale), "colorbar": colour_bar(layer)}


def colour_bar(layer: Layer) -> dict[str, Any]:
    """Slim, with name and unit beside it."""
    return {"title": {"text": titled(layer), "side": "right"}, "thickness": 14, "outlinewidth": 0, "ticks": "outside"}


def colorscale(scale: Scale) -> list[list[Any]]:
    """Colours at even steps, as plotly takes them."""
    steps = np.linspace(0.0, 1.0, 33)
    shades = (255.0 * scale.colours(steps)[:, :3]).round().astype(int)
    return [[float(step), f"rgb({r},{g},{b})"] for step, (r, g, b) in zip(steps, shades.tolist(), strict=True)]


def layout(title: str, x: Mapping[str, Any], y: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    """White, with a frame; the title at the left."""
    frame = {"mirror": True, "showline": True, "linecolor": INK, "linewidth": 1, "ticks": "inside", "zeroline": False}
    return {
        "title": {"text": title, "x": 0.0, "xanchor": "left", "font": {"size": 14}, "pad": {"l": 8}},
        "font": FONT, "paper_bgcolor": "white", "plot_bgcolor": "white", "showlegend": False,
        "margin": {"l": 62, "r": 12, "t": 62, "b": 52}, "dragmode": "zoom",
        "hoverlabel": {"bgcolor": "white", "bordercolor": PALE, "align": "left", "font": FONT},
        "xaxis": {"showgrid": False, **frame, **x}, "yaxis": {"showgrid": False, **frame, **y}, **more,
    }  # fmt: skip


def plane_axes(chart: Chart) -> tuple[dict[str, Any], dict[str, Any]]:
    """Both axes of a plane, at one scale for lengths."""
    first, second = chart.axes[:2]
    x = {"title": {"text": labelled(first), "standoff": 6}, "range": _ends(first.values), "constrain": "domain"}
    y = {"title": {"text": labelled(second)}, "range": _ends(second.values), "constrain": "domain"}
    return x, y | ({"scaleanchor": "x", "scaleratio": 1.0} if first.unit == second.unit == "m" else {})


def _ends(values: NDArray[Any]) -> list[float]:
    return [float(values[0]), float(values[-1])]


def heading(layer: Layer, *more: str, scale: Scale | None = None) -> str:
    """A panel's title: the layer, what its zero means, and what else there is to say, in a second line."""
    words = [f"zero: {layer.zero_is}"] if layer.zero_is else []
    words += ["some values lie beyond the colours"] if scale is not None and (scale.below or scale.above) else []
    return f"<b>{layer.title}</b>" + (f"<br><sup>{' · '.join([*words, *more])}</sup>" if [*words, *more] else "")


def labelled(axis: Axis) -> str:
    """An axis' name and unit."""
    return axis.name if axis.unit == "1" else f"{axis.name} [{raised(axis.unit)}]"


def titled(layer: Layer) -> str:
    """A layer's title and unit."""
    return layer.title if layer.unit == "1" else f"{layer.title} [{raised(layer.unit)}]"


def unit_of(axis: Axis) -> str:
    """A unit for a line of text, nothing for plain numbers."""
    return "" if axis.unit == "1" else raised(axis.unit)


def layer_unit(layer: Layer) -> str:
    """A unit for a line of text, nothing for plain numbers."""
    return "" if layer.unit == "1" else raised(layer.unit)


def raised(unit: str) -> str:
    """A unit with its exponents raised."""
    return re.sub(r"\^(-?\w+)", r"<sup>\1</sup>", unit)
