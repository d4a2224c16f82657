"""What pictures of sweeps share, on paper and on the screen: colours, zero lines, signs for cells without a value."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from contourpy import FillType, LineType, contour_generator
from matplotlib import colormaps
from matplotlib.colors import Colormap, LinearSegmentedColormap
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.report.style import DIVERGING, PALE
from flexbase.sweeps.answers.chart import INFINITE, Layer
from flexbase.sweeps.engine.status import GAINED, INDEFINITE, INFEASIBLE, LOST, SINGULAR, UNREACHABLE, UNSTABLE

TAIL = 4.0  # percent of the cells at either end that the colours may leave out
PATTERN = {  # of matplotlib's hatches
    UNREACHABLE: "///",
    SINGULAR: "...",
    INDEFINITE: "xxx",
    INFEASIBLE: "|||",
    LOST: "\\\\\\",
    GAINED: "+++",
    UNSTABLE: "---",
    INFINITE: "",
}
UNKNOWN = ""  # no hatch: cells that are not computed yet


def face(code: int) -> str:
    """The colour under a pattern."""
    return PALE if code == INFINITE else "white"


class Scale(NamedTuple):
    """Colours of a layer, from `low` to `high`; `below` and `above` say whether some values lie outside."""

    low: float
    high: float
    colours: Colormap
    below: bool
    above: bool


def scale_of(layer: Layer) -> Scale | None:
    """Diverging about zero where that means something, or the half of it that occurs; else sequential; None: no values.

    Spans the middle 92 percent of the cells.
    """
    known = layer.known
    if not known.size:
        return None
    least, most = float(known.min()), float(known.max())
    low, high = (float(bound) for bound in np.percentile(known, [TAIL, 100.0 - TAIL]))
    colours = colormaps["viridis"]
    if layer.zero_is is not None:
        size = max(abs(low), abs(high)) or max(abs(least), abs(most)) or 1.0
        low, high = -size if least < 0.0 else 0.0, size if most > 0.0 else 0.0
        low, high = (low, high) if low < high else (-1.0, 1.0)
        colours = _part(low, high)
    elif high <= low:
        low, high = (least, most) if least < most else _around(low)
    return Scale(low, high, colours, least < low, most > high)


def _part(low: float, high: float) -> Colormap:
    full = colormaps[DIVERGING]
    if low == 0.0:
        return LinearSegmentedColormap.from_list("above", full(np.linspace(0.5, 1.0, 128)))
    if high == 0.0:
        return LinearSegmentedColormap.from_list("below", full(np.linspace(0.0, 0.5, 128)))
    return full


def _around(value: float) -> tuple[float, float]:
    """A span about a constant."""
    half = 0.05 * abs(value) or 1.0
    return value - half, value + half


def zero_paths(x: Array, y: Array, layer: Layer) -> list[Array]:
    """Where a layer of shape (rows, columns) is zero: lines of points (x, y), shape (points, 2) each.

    Linear between cells.
    """
    return [] if layer.zeros is None else level_paths(x, y, layer.zeros, 0.0)


def level_paths(x: Array, y: Array, field: Array, level: float) -> list[Array]:
    """Where a field crosses a level, from values on both sides of it; none on a grid of one row or column."""
    known = field[np.isfinite(field)]
    if min(field.shape) < 2 or not known.size or not known.min() < level < known.max():
        return []
    lines = contour_generator(x, y, np.ma.masked_invalid(field), line_type=LineType.Separate, corner_mask=True)
    return [np.asarray(line) for line in lines.lines(level)]


def outlines(x: Array, y: Array, where: NDArray[np.bool_]) -> list[list[Array]]:
    """The regions of marked cells: of each the outline and its holes, closed, half a cell beyond the cells' middles.

    Shape (points, 2) each; holes run the other way round.
    """
    framed = np.pad(where, 1).astype(float)
    wide, high = (np.concatenate([[_beyond(axis)], axis, [_beyond(axis[::-1])]]) for axis in (x, y))
    filled = contour_generator(wide, high, framed, fill_type=FillType.OuterOffset).filled(0.5, 1.5)
    regions = []
    for points, offsets in zip(*filled, strict=True):
        inside = np.clip(points, [x[0], y[0]], [x[-1], y[-1]]) if min(len(x), len(y)) > 1 else points
        regions.append([inside[a:b] for a, b in zip(offsets[:-1], offsets[1:], strict=True)])
    return regions


def _beyond(axis: Array) -> float:
    return float(2.0 * axis[0] - axis[1])
