"""A sweep's answer as a sheet, as plain numbers, and as a table on disk."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flexbase.checks import Array
from flexbase.measures import MEASURES
from flexbase.sheets.numbers import number
from flexbase.sheets.plain import plain
from flexbase.sheets.sheet import Column, Sheet, facts, make_sheet, table, words
from flexbase.sweeps.answers.tables import check_small, dims_of, places_of, write_columns
from flexbase.sweeps.engine.question import COMPANION, MEASURED, MODE
from flexbase.sweeps.engine.status import statuses_of

if TYPE_CHECKING:
    import xarray


PART = 1 << 22  # cells of a store that are looked at together


class Extent(NamedTuple):
    """The smallest and largest value of a measure, NaN where it has none; `mode` counts from 1, 0 stands for none."""

    measure: str
    mode: int
    smallest: float
    largest: float
    unit: str

    def row(self) -> tuple[str, ...]:
        """In words."""
        ends = (number(self.smallest, 7), number(self.largest, 7)) if self.smallest == self.smallest else ("none",) * 2
        return self.measure, str(self.mode) if self.mode else "", *ends, self.unit


COLUMNS = (words("measure"), Column("mode"), Column("smallest"), Column("largest"), words("unit"))


def measures_of(dataset: xarray.Dataset) -> list[str]:
    """Names of the measures that were asked for: registered ones, and those that say so themselves."""
    named = (str(name) for name in dataset.data_vars if name in MEASURES or MEASURED in dataset[name].attrs)
    return [name for name in named if COMPANION not in dataset[name].attrs]


def extents(dataset: xarray.Dataset) -> list[Extent]:
    """Every measure's extent, read a part at a time."""
    found = []
    for name in measures_of(dataset):
        variable = dataset[name]
        modes = dataset.sizes[MODE] if MODE in variable.dims else 0
        low, high = np.full(max(modes, 1), np.nan), np.full(max(modes, 1), np.nan)
        for part in _parts(dataset, variable):
            values = part.reshape(-1, max(modes, 1))
            low = np.fmin(low, np.fmin.reduce(values, axis=0, initial=np.nan))
            high = np.fmax(high, np.fmax.reduce(values, axis=0, initial=np.nan))
        unit = str(variable.attrs["units"])
        found += [
            Extent(name, i + 1 if modes else 0, float(low[i]), float(high[i]), unit) for i in range(max(modes, 1))
        ]
    return found


def counts(dataset: xarray.Dataset) -> dict[int, int]:
    """How many cells have each status; those that none has are left out."""
    total = np.zeros(1 + max(statuses_of(dataset)), dtype=np.int64)
    for part in _parts(dataset, dataset["status"]):
        total += np.bincount(part.ravel(), minlength=len(total))
    return {code: int(number) for code, number in enumerate(total) if number}


def _parts(dataset: xarray.Dataset, variable: xarray.DataArray) -> Iterator[Array]:
    """The values of a variable, along its first dimension."""
    first = variable.dims[0]
    step = max(1, PART // max(1, variable.size // dataset.sizes[first]))
    for begin in range(0, dataset.sizes[first], step):
        yield np.asarray(variable.isel({first: slice(begin, begin + step)}).values)


def sheet_of(dataset: xarray.Dataset) -> Sheet:
    """Axes and cells, what zeros mean, and the smallest and largest value of each measure."""
    given, meanings = dataset.attrs, statuses_of(dataset)
    judged, compensated = given.get("judged"), "with" if given["compensated"] else "without"
    of = f"of {judged}" if judged else f"{compensated} compensator"
    axes = [(f"axis {name}", _ends(dataset[name])) for name in reversed(dims_of(dataset))]
    cells = [(meanings[code], f"{count} cells") for code, count in counts(dataset).items()]
    zeros = [(f"{name} = 0", zero) for name in measures_of(dataset) if (zero := dataset[name].attrs.get("zero_is"))]
    return make_sheet(
        given["robot"],
        f"map {given.get('difference', of)}",
        facts(*axes, *cells, *zeros),
        table(COLUMNS, (one.row() for one in extents(dataset))),
        cautions=str(given.get("cautions", "")).splitlines(),
    )


def _ends(axis: xarray.DataArray) -> str:
    unit = "" if axis.attrs["units"] == "1" else f" {axis.attrs['units']}"
    return f"{number(float(axis[0]), 6)} to {number(float(axis[-1]), 6)}{unit}, {axis.size} cells"


def document(dataset: xarray.Dataset) -> dict[str, Any]:
    """Plain numbers; cells without a value hold None. Axes fastest first. Raises InputError for a very large sweep."""
    check_small(dataset)
    return {
        "robot": dataset.attrs["robot"],
        "compensated": bool(dataset.attrs["compensated"]),
        **({"difference": dataset.attrs["difference"]} if "difference" in dataset.attrs else {}),
        "axes": [
            {"name": name, "unit": dataset[name].attrs["units"], "values": dataset[name].values.tolist()}
            for name in reversed(dims_of(dataset))
        ],
        "measures": {
            name: {"unit": dataset[name].attrs["units"], "values": plain(dataset[name].values)}
            for name in measures_of(dataset)
        },
        "status": dataset["status"].values.tolist(),
        "status_codes": {str(code): meaning for code, meaning in statuses_of(dataset).items()},
    }


def save_csv(dataset: xarray.Dataset, path: str | Path) -> None:
    """One line a cell. Raises InputError where the place cannot be written, and for a very large sweep."""
    check_small(dataset)
    columns = places_of(dataset)
    for name in measures_of(dataset):
        values = dataset[name].values
        if MODE in dataset[name].dims:
            columns |= {f"{name}_{i + 1}": values[..., i] for i in range(values.shape[-1])}
        else:
            columns[name] = values
    write_columns(path, {**columns, "status": dataset["status"].values})
