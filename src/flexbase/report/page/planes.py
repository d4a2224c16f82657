"""Panels of maps: a plane; a plane with a slider along the third axis; and all its slices in space."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexbase.report.maps.plane_maps import empty_words
from flexbase.report.maps.signs import Scale, scale_of
from flexbase.report.page.traces import (
    colorscale,
    colour_bar,
    heading,
    labelled,
    layer_unit,
    layout,
    plane_axes,
    plane_traces,
    unit_of,
)
from flexbase.sweeps.answers.chart import Chart, Layer

Panel = dict[str, Any]  # data and layout
STACKED = 120  # cells along an axis of a slice in space


def plane_panels(chart: Chart) -> list[Panel]:
    """A panel a layer."""
    panels = []
    for layer in chart.layers:
        (x, y), scale = plane_axes(chart), scale_of(layer)
        said = layout(heading(layer, scale=scale), x, y, annotations=_remarks(layer))
        panels.append({"data": plane_traces(chart, layer, scale), "layout": said})
    return panels


def slice_panels(chart: Chart) -> list[Panel]:
    """Two panels a layer: one slice, chosen by a slider, and all in space; colours are the same in all slices."""
    panels = []
    for layer, scale in ((layer, scale_of(layer)) for layer in chart.layers):
        panels.append(_slider(chart, layer, scale))
        if scale is not None:
            panels.append(_stack(chart, layer, scale))
    return panels


def _slider(chart: Chart, layer: Layer, scale: Scale | None) -> Panel:
    place, axis = chart.layers.index(layer), chart.axes[2]
    groups = [plane_traces(plane, plane.layers[place], scale) for _, plane in chart.slices()]
    open_at = int(np.isfinite(layer.values).sum(axis=(1, 2)).argmax())  # where most is to be seen
    traces = [(i, trace) for i, group in enumerate(groups) for trace in group]
    steps = [
        {"label": f"{value:.4g}", "method": "restyle", "args": [{"visible": [i == one for one, _ in traces]}]}
        for i, value in enumerate(axis.values)
    ]
    shown = {"prefix": f"{axis.name} = ", "suffix": f" {unit_of(axis)}", "font": {"size": 13}, "xanchor": "left"}
    slider = {"steps": steps, "currentvalue": shown, "pad": {"t": 56, "b": 4}, "len": 0.94, "x": 0.0, "active": open_at}
    x, y = plane_axes(chart)
    said = layout(heading(layer, scale=scale), x, y, sliders=[slider], annotations=_remarks(layer))
    data = [{**trace, "visible": i == open_at} for i, trace in traces]
    return {"data": data, "layout": said}


def _stack(chart: Chart, layer: Layer, scale: Scale) -> Panel:
    first, second, third = chart.axes
    rows, columns = (slice(None, None, -(-axis.values.size // STACKED)) for axis in (second, first))
    where = "".join(
        f"{axis.name} %{{{sign}:.5g}} {unit_of(axis)}<br>" for axis, sign in zip(chart.axes, "xyz", strict=True)
    )
    where += f"<b>{layer.title} %{{surfacecolor:.5g}} {layer_unit(layer)}</b><extra></extra>"
    data = []
    for i, height in enumerate(third.values):
        values = layer.finite[i, rows, columns].astype(np.float32)
        data.append(
            {
                "type": "surface", "x": first.values[columns], "y": second.values[rows],
                "z": np.where(np.isnan(values), np.nan, height).astype(np.float32), "surfacecolor": values,
                "cmin": scale.low, "cmax": scale.high, "colorscale": colorscale(scale), "showscale": i == 0,
                "colorbar": colour_bar(layer), "lighting": {"ambient": 1.0, "diffuse": 0.0, "specular": 0.0},
                "hovertemplate": where,
            }
        )  # fmt: skip
    lengths = [abs(axis.values[-1] - axis.values[0]) if axis.unit == "m" else np.nan for axis in chart.axes]
    ratio = np.nan_to_num(np.array(lengths) / np.nanmax([*lengths[:2], 1e-9]), nan=1.0)
    scene: dict[str, Any] = {
        f"{sign}axis": {"title": {"text": labelled(axis)}, "range": [float(axis.values[0]), float(axis.values[-1])]}
        for axis, sign in zip(chart.axes, "xyz", strict=True)
    }
    scene |= {"aspectmode": "manual", "aspectratio": dict(zip("xyz", ratio.tolist(), strict=True))}
    scene |= {"camera": {"eye": {"x": 1.5, "y": -1.7, "z": 1.0}}}
    said = layout(heading(layer, f"{third.values.size} slices along {third.name}", scale=scale), {}, {}, scene=scene)
    return {"data": data, "layout": {**said, "margin": {"l": 0, "r": 12, "t": 62, "b": 8}}}


def _remarks(layer: Layer) -> list[dict[str, Any]]:
    if layer.known.any():
        return []
    place = {"x": 0.5, "y": 0.5, "xref": "paper", "yref": "paper", "showarrow": False, "bgcolor": "white"}
    return [{"text": empty_words(layer), **place}]
