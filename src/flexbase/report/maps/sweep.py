"""A sweep as a figure: curves, a map, slices or samples, by its axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from flexbase.report.maps.line_curves import draw_curves
from flexbase.report.maps.plane_maps import draw_plane, draw_slices
from flexbase.report.maps.samples import draw_samples
from flexbase.sweeps.answers.chart import Chart, chart_of

if TYPE_CHECKING:
    import xarray


def draw_dataset(dataset: xarray.Dataset) -> Figure:
    """All measures of a sweep. Raises InputError for one that no picture shows."""
    return draw_chart(chart_of(dataset))


def draw_chart(chart: Chart) -> Figure:
    """All layers of a chart."""
    if chart.axes[0].name == "sample":
        return draw_samples(chart)
    return (draw_curves, draw_plane, draw_slices)[len(chart.axes) - 1](chart)
