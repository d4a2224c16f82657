"""A sweep ready to be drawn: thinned to what a picture can show, each measure and mode a layer, whatever the axes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.measures import MEASURES
from flexbase.sweeps.answers.angles import crossing
from flexbase.sweeps.answers.summary import measures_of
from flexbase.sweeps.answers.tables import dims_of
from flexbase.sweeps.cells.axis import Axis
from flexbase.sweeps.engine.question import MODE
from flexbase.sweeps.engine.status import statuses_of

if TYPE_CHECKING:
    import xarray


LARGEST = 1000  # cells along an axis that are drawn: more are thinned out evenly
SLICES = 6  # of a third axis
INFINITE = 15  # beside the codes of statuses: cells whose value has no bound
POINTS = 200_000  # samples: the first so many, which are as evenly spread as all


class Layer(NamedTuple):
    """One measure, or one mode of it.

    values : shape of the chart's status, NaN where there is none
    zero_is : what zero means, or None where it means nothing
    zeros : of the same shape, changes its sign where the values are zero, and nowhere else; None: zero means nothing
    """

    name: str
    title: str
    unit: str
    values: Array
    zero_is: str | None = None
    zeros: Array | None = None

    @property
    def finite(self) -> Array:
        """The values, NaN where they are infinite."""
        return np.where(np.isfinite(self.values), self.values, np.nan)

    @property
    def known(self) -> Array:
        """The finite values, in a row."""
        return self.values[np.isfinite(self.values)]


@dataclass(frozen=True, eq=False)
class Chart:
    """Layers over one to three axes, or over samples.

    remark : what is special about the sweep, such as a compensator or a value that stands still, or nothing
    axes : of the cells, fastest first: x, y, and the axis of slices; for samples, their number
    status : shape (slices, rows, columns), (rows, columns) or (cells,); `meanings` says what its codes are
    drawn : of samples, the coordinates that were drawn, each with one value a sample
    cells : of the sweep, in words, of which the chart may show fewer; recipe : its digest, or nothing
    """

    robot: str
    remark: str
    axes: tuple[Axis, ...]
    layers: tuple[Layer, ...]
    status: NDArray[np.int8]
    meanings: Mapping[int, str]
    drawn: tuple[Axis, ...] = ()
    cells: str = ""
    recipe: str = ""

    @property
    def heading(self) -> str:
        """Robot and remark."""
        return f"{self.robot}, {self.remark}" if self.remark else self.robot

    def missing(self, layer: Layer) -> dict[int, NDArray[np.bool_]]:
        """Cells that a layer cannot show, by their status; none where a value exists, whatever the status."""
        gaps = np.isnan(layer.values)
        found = {code: gaps & (self.status == code) for code in self.meanings}
        found[INFINITE] = np.isinf(layer.values)
        return {code: cells for code, cells in found.items() if cells.any()}

    def slices(self) -> Iterator[tuple[str, Chart]]:
        """Every value of the third axis in words, and the chart of the plane there."""
        axis = self.axes[2]
        for i, value in enumerate(axis.values):
            layers = tuple(
                one._replace(values=one.values[i], zeros=None if one.zeros is None else one.zeros[i])
                for one in self.layers
            )
            words = said(axis.name, float(value), axis.unit)
            yield words, replace(self, axes=self.axes[:2], layers=layers, status=self.status[i])


def said(name: str, value: float, unit: str) -> str:
    """A coordinate in words, such as payload = 2.5 kg."""
    return f"{name} = {value:.4g}" if unit == "1" else f"{name} = {value:.4g} {unit}"


def chart_of(dataset: xarray.Dataset, largest: int = LARGEST, slices: int = SLICES) -> Chart:
    """The picture of a sweep over up to three axes, or over samples; only the cells that it shows are kept in memory.

    largest, slices : as `thinned` takes them
    Raises InputError for more axes, for a single cell, and for what is no sweep.
    """
    plane = thinned(dataset, largest, slices)
    dims = _dims(plane)
    plane = plane.isel({dim: 0 for dim in plane["status"].dims if dim not in dims}).load()
    coordinates = [name for name in map(str, plane.coords) if _is_drawn(plane, name, dims)]
    return Chart(
        str(plane.attrs["robot"]),
        _remark(plane),
        tuple(_axis(plane, dim) for dim in reversed(dims)),
        tuple(_layers(plane)),
        plane["status"].values,
        {**statuses_of(plane), INFINITE: "infinite"},
        tuple(_axis(plane, name) for name in coordinates),
        " x ".join(str(dataset.sizes[dim]) for dim in reversed(dims)),
        str(plane.attrs.get("flexbase_recipe_digest", "")),
    )


def thinned(dataset: xarray.Dataset, largest: int = LARGEST, slices: int = SLICES) -> xarray.Dataset:
    """The cells of a sweep that a picture shows, still unread: evenly chosen, of samples the first.

    largest : cells along an axis; slices : of a third axis, both ends among them
    Raises InputError for more than three axes, for a single cell, and for what is no sweep.
    """
    if "status" not in dataset or not measures_of(dataset):
        raise InputError("plot: this dataset holds no sweep. Give what flexbase.sweeps or open_dataset returned.")
    dims = _dims(dataset)
    if not dims:
        raise InputError("plot: a single cell makes no picture. Read it with flexbase.summary, or ask for more cells.")
    if len(dims) > 3:
        raise InputError(
            f"plot: this sweep has {len(dims)} axes ({', '.join(dims)}), a picture has up to three. Choose values of "
            f'the others, with dataset.sel({dims[0]}=VALUE, method="nearest") or flexbase draw --at {dims[0]}=VALUE.'
        )
    if dims == ("sample",):
        return dataset.isel(sample=slice(0, POINTS))
    chosen: dict[str, Any] = {dim: _thinned(dataset.sizes[dim], largest) for dim in dims[-2:]}
    return dataset.isel({**chosen, **{dim: _chosen(dataset.sizes[dim], slices) for dim in dims[:-2]}})


def _dims(dataset: xarray.Dataset) -> tuple[str, ...]:
    """Axes with more than one value."""
    return tuple(dim for dim in dims_of(dataset) if dataset.sizes[dim] > 1)


def _is_drawn(plane: xarray.Dataset, name: str, dims: tuple[str, ...]) -> bool:
    return dims == ("sample",) and plane[name].dims == dims and name not in dims


def _thinned(size: int, largest: int) -> slice:
    """Every so many cells, as far from one end as from the other."""
    step = -(-size // largest)
    return slice((size - 1) % step // 2, None, step)


def _chosen(size: int, slices: int) -> list[int]:
    """Both ends and some between, at equal distances where four or more can be."""
    if size <= slices:
        return list(range(size))
    even = [count for count in range(4, slices + 1) if (size - 1) % (count - 1) == 0]
    return [round(place) for place in np.linspace(0, size - 1, max(even, default=slices)).tolist()]


def _axis(plane: xarray.Dataset, name: str) -> Axis:
    return Axis(name, str(plane[name].attrs.get("units", "1")), plane[name].values)


def _layers(plane: xarray.Dataset) -> Iterator[Layer]:
    for name in measures_of(plane):
        variable = plane[name]
        unit, zero_is = str(variable.attrs["units"]), variable.attrs.get("zero_is")
        line = name  # or, where the measure only touches zero, its companion
        known = MEASURES.get(name)
        if known is not None and zero_is == known.zero_is and known.zero_line in plane:
            line = known.zero_line or name
        modes = range(plane.sizes[MODE]) if MODE in variable.dims else (None,)
        for mode in modes:
            values, zeros = (
                (plane[one] if mode is None else plane[one].isel({MODE: mode})).values for one in (name, line)
            )
            title = f"{name}, mode {mode + 1}" if mode is not None and len(modes) > 1 else name
            yield Layer(name, title, unit, values, zero_is, crossing(line, zeros) if zero_is else None)


def _remark(plane: xarray.Dataset) -> str:
    """What the sweep's attributes say, and where axes that do not show stand."""
    still = [name for name in map(str, plane.coords) if not plane[name].dims and name not in (MODE, "sample")]
    words = [said(name, float(plane[name]), str(plane[name].attrs.get("units", "1"))) for name in still]
    given = plane.attrs
    state = given.get("difference") or given.get("judged") or ("compensated" if given["compensated"] else "")
    return ", ".join([state, *words] if state else words)
