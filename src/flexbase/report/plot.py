"""Draw any result: `plot` chooses by its type, `save_plot` writes a file.

One function a type, registered on `plot`; a new result is drawn by one more.
"""

from __future__ import annotations

from functools import singledispatch
from pathlib import Path
from typing import TYPE_CHECKING, TypeGuard

from matplotlib.figure import Figure

from flexbase.control.compensator import Compensator
from flexbase.errors import InputError
from flexbase.linear.modal import Modes
from flexbase.linear.passivity.verdict import Verdict
from flexbase.measures.manipulability import Manipulability
from flexbase.report.figures.compensator import draw_compensator
from flexbase.report.figures.layout import draw_layout
from flexbase.report.figures.manipulability import draw_manipulability
from flexbase.report.figures.modes import draw_modes
from flexbase.report.figures.postures import draw_postures
from flexbase.report.figures.region import draw_validity
from flexbase.report.figures.robust_curves import draw_robust_curves
from flexbase.report.figures.robust_points import draw_robust_points
from flexbase.report.figures.run import draw_run
from flexbase.report.figures.sampled_run import draw_sampled
from flexbase.report.figures.verdict import draw_verdict
from flexbase.report.maps.probability import draw_probability
from flexbase.report.maps.sweep import draw_chart, draw_dataset
from flexbase.report.save import check_picture_path, save_figure
from flexbase.report.style import styled
from flexbase.simulation import Run, SampledRun
from flexbase.study.layout.best_layout import Layout
from flexbase.study.montecarlo import MonteCarlo, is_study
from flexbase.study.postures.best_postures import Postures
from flexbase.study.robust_configurations.curves import RobustCurves
from flexbase.study.robust_configurations.points import RobustPoints
from flexbase.study.running.region import Region
from flexbase.sweeps.answers.chart import Chart

if TYPE_CHECKING:
    import xarray

PAGE = ".html"


@singledispatch
def plot(result: object) -> Figure:
    """A figure of a result: any of the types registered below, or the `Dataset` of a sweep or study.

    A sweep may have one to three axes: curves, maps, slices. The figure belongs to no window: save it with `save_plot`,
    or show it in a notebook.
    Raises InputError for anything else.
    """
    if _is_dataset(result):
        return plot(MonteCarlo(result)) if is_study(result) else styled()(draw_dataset)(result)
    drawable = ", ".join(kind.__name__ for kind in plot.registry if kind is not object)
    raise InputError(f"plot: a {type(result).__name__} cannot be drawn. Give one of {drawable}.")


plot.register(Modes)(styled()(draw_modes))
plot.register(Verdict)(styled()(draw_verdict))
plot.register(Compensator)(styled()(draw_compensator))
plot.register(Run)(styled()(draw_run))
plot.register(SampledRun)(styled()(draw_sampled))
plot.register(Chart)(styled()(draw_chart))
plot.register(Manipulability)(styled()(draw_manipulability))
plot.register(Postures)(styled()(draw_postures))
plot.register(RobustCurves)(styled()(draw_robust_curves))
plot.register(RobustPoints)(styled()(draw_robust_points))
plot.register(Layout)(styled()(draw_layout))
plot.register(MonteCarlo)(styled()(draw_probability))
plot.register(Region)(styled()(draw_validity))


def save_plot(result: object, path: str | Path) -> None:
    """Draw a result into a file, png, svg or pdf by its suffix; sweeps also as html, one page that needs no network.

    Raises InputError for a result that cannot be drawn, another suffix, or a place that cannot be written; MissingExtra
    for a page without plotly.
    """
    if Path(path).suffix.lower() == PAGE and (isinstance(result, Chart) or _is_sweep(result)):
        from flexbase.report.page.write import save_page

        return save_page(result, path)
    check_picture_path(path)  # before the work of drawing
    save_figure(plot(result), path)


def _is_sweep(result: object) -> TypeGuard[xarray.Dataset]:
    return _is_dataset(result) and not is_study(result)


def _is_dataset(result: object) -> TypeGuard[xarray.Dataset]:
    """Whether it is a sweep or a study; xarray itself takes long to import."""
    return type(result).__module__.startswith("xarray")
