"""How sure a design is: at a pose by criterion and parameter, over one axis as a curve, over two as a map."""

from __future__ import annotations

import textwrap
from typing import Literal

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from flexbase.errors import InputError
from flexbase.report.maps.signs import PATTERN, level_paths, outlines
from flexbase.report.style import BLUE, GREY, HATCH, INK, ORANGE, PALE, new_figure
from flexbase.study.montecarlo import LEVELS, MonteCarlo
from flexbase.sweeps.engine.status import OK, STATUS

BANDS = (0.0, 0.05, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99, 1.0)  # of probability, a colour each
COLOURS = ListedColormap(colormaps["YlGnBu"](np.linspace(0.05, 0.95, len(BANDS) - 1)))
LINES: tuple[tuple[float, str, Literal["--", "-"]], ...] = ((0.5, INK, "--"), (0.95, ORANGE, "-"))  # contours
BINS = 24
COLUMNS = 3


def draw_probability(result: MonteCarlo) -> Figure:
    """A picture by the number of axes: none (a pose), one or two. Raises InputError for more."""
    axes = result.dataset["probability"].ndim
    if axes > 2:
        names = ", ".join(map(str, result.dataset["probability"].dims))
        raise InputError(f"plot: this study has {axes} axes ({names}), a picture has up to two. Give two with axes.")
    return (_pose, _curve, _map)[axes](result)


def _map(result: MonteCarlo) -> Figure:
    found = result.dataset
    rows, columns = found["probability"].dims
    x, y = found[columns].values, found[rows].values
    figure = new_figure(9.8, 5.1)
    if isinstance(engine := figure.get_layout_engine(), ConstrainedLayoutEngine):
        engine.set(wspace=0.06)
    ax, beside = figure.subplots(1, 2, width_ratios=(1.75, 1.0))
    status, keys = found["status"].values, []
    for code, pattern in PATTERN.items():
        if (cells := status == code).any():
            for region in outlines(x, y, cells):
                path = Path.make_compound_path(*(Path(line, closed=True) for line in region))
                ax.add_patch(PathPatch(path, facecolor="white", edgecolor=HATCH, hatch=pattern, linewidth=0))
            keys.append(Patch(facecolor="white", edgecolor=HATCH, hatch=pattern, linewidth=0, label=STATUS[code]))
    probability = found["probability"].values
    norm = BoundaryNorm(BANDS, COLOURS.N)
    ax.pcolormesh(x, y, probability, norm=norm, cmap=COLOURS, shading="nearest", rasterized=True)
    lines = []
    for level, colour, dashes in LINES:
        for line in (paths := level_paths(x, y, probability, level)):
            ax.plot(*line.T, color=colour, linestyle=dashes, linewidth=1.3)
        lines += [Line2D([], [], color=colour, linestyle=dashes, label=f"probability {level:g}")] if paths else []
    bar = figure.colorbar(ScalarMappable(norm, COLOURS), ax=ax, ticks=BANDS, aspect=28, pad=0.02, shrink=0.9)
    bar.set_label("probability that the design holds")
    units = [found[name].attrs["units"] for name in (columns, rows)]
    if units[0] == units[1] == "m":
        ax.set_aspect("equal")
    if not (status == OK).any():
        ax.text(0.5, 0.5, "no cell can be judged", transform=ax.transAxes, ha="center", backgroundcolor="white")
    ax.set(xlim=x[[0, -1]], ylim=y[[0, -1]], xlabel=f"{columns} [{units[0]}]", ylabel=f"{rows} [{units[1]}]")
    _shares(beside, result)
    _heading(figure, result)
    if handles := [*lines, *keys]:
        figure.legend(handles=handles, loc="outside lower center", ncols=min(4, len(handles)))
    return figure


def _shares(ax: Axes, result: MonteCarlo) -> None:
    """The share of the workspace that holds with at least some probability, as a function of that."""
    levels = np.linspace(0.005, 1.0, 200)
    found = np.array([result.share_at_least(float(level)) for level in levels])
    ax.fill_between(levels, found[:, 1], found[:, 2], step="mid", color=BLUE, alpha=0.25, linewidth=0)
    ax.step(levels, found[:, 0], where="mid", color=BLUE)
    for level in LEVELS[::2]:
        share = result.share_at_least(level).value
        if np.isfinite(share):
            ax.plot(level, share, "o", color=BLUE, markersize=4)
            below = -12 if share > 0.1 else 6
            said = f"{100.0 * share:.3g} % at {level:g}"
            ax.annotate(said, (level, share), (-4, below), textcoords="offset points", ha="right")
    ax.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0), xlabel="probability p", ylabel="share of the workspace that holds")
    ax.set_title("with probability p or more, and 95 % interval", loc="left", fontsize=9)
    ax.grid(True)
    ax.set_axisbelow(True)


def _curve(result: MonteCarlo) -> Figure:
    found = result.dataset
    (name,) = found["probability"].dims
    x = found[name].values
    figure = new_figure(5.6, 3.6)
    ax = figure.add_subplot()
    ax.fill_between(x, found["lower"], found["upper"], color=BLUE, alpha=0.25, linewidth=0, label="95 % interval")
    ax.plot(x, found["probability"], color=BLUE, label="all criteria")
    for i, one in enumerate(found["criterion"].values.tolist()):
        ax.plot(x, found["criterion_probability"][i], color=GREY, linestyle=(0, (1 + 2 * i, 2)), linewidth=1, label=one)
    ax.set(xlim=x[[0, -1]], ylim=(-0.02, 1.02), xlabel=f"{name} [{found[name].attrs['units']}]", ylabel="probability")
    figure.legend(loc="outside lower center", ncols=3)
    _heading(figure, result)
    return figure


def _pose(result: MonteCarlo) -> Figure:
    found = result.dataset
    names = [name for name in found.coords if found[name].dims == ("draw",)]
    varied = [name for name in names if np.ptp(found[name].values) > 0.0]
    panels = 1 + len(varied)
    columns = 2 if panels == 4 else min(panels, COLUMNS)
    rows = -(-panels // columns)
    figure = new_figure(3.2 * columns + 0.4, 2.7 * rows + 0.7)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    _criteria(axes[0], result)
    holds = found["share"].values > 0.5
    for ax, name in zip(axes[1:], varied, strict=False):
        values = found[name].values
        edges = np.linspace(values.min(), values.max(), BINS + 1).tolist()
        parts, colours = [values[holds], values[~holds]], [BLUE, ORANGE]
        ax.hist(parts, edges, stacked=True, color=colours, edgecolor="white", linewidth=0.3)
        unit = found[name].attrs["units"]
        ax.set(xlim=(edges[0], edges[-1]), xlabel=name if unit == "1" else f"{name} [{unit}]", ylabel="draws")
    for ax in axes[panels:]:
        ax.set_axis_off()
    if varied:
        signs = [Patch(color=BLUE, label="holds"), Patch(color=ORANGE, label="fails")]
        figure.legend(handles=signs, loc="outside lower center", ncols=2)
    _heading(figure, result)
    return figure


def _criteria(ax: Axes, result: MonteCarlo) -> None:
    """Probability of everything with its interval, and of each criterion by itself."""
    found, whole = result.dataset, result.at_pose
    names = ["all", *found["criterion"].values.tolist()]
    values = [whole.value, *found["criterion_probability"].values.ravel().tolist()]
    places = np.arange(len(names))[::-1]
    ax.barh(places, values, 0.6, color=[BLUE] + [PALE] * (len(names) - 1))
    ax.plot([whole.lower, whole.upper], [places[0]] * 2, color=INK, linewidth=1.6, marker="|", markersize=8)
    for place, value in zip(places, values, strict=True):
        ax.text(
            0.02,
            place,
            f"{value:.3f}",
            va="center",
            fontsize=8,
            color="white" if place == places[0] and value > 0.15 else INK,
        )
    ax.set_yticks(places, names)
    ax.set(xlim=(0.0, 1.0), xlabel="probability, 95 % interval")
    ax.tick_params(axis="y", length=0)


def _heading(figure: Figure, result: MonteCarlo) -> None:
    """What was asked: the design, what varied, and what holding means."""
    said = result.dataset.attrs
    lines = [f"{said['robot']}, {said['design']}: {result.dataset.sizes['draw']} draws, seed {said['seed']}"]
    for name, text in (("varied", said["vary"]), ("to hold", said["criteria"])):
        lines += textwrap.wrap(f"{name}: {text}", int(14.5 * figure.get_figwidth()), subsequent_indent="    ")
    figure.suptitle("\n".join(lines), x=0.01, ha="left", fontsize=8.5)
