"""Answers as files: CSV tables with all digits, and NetCDF."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from flexbase.errors import InputError, writing

if TYPE_CHECKING:
    import xarray

LARGEST_TABLE = 4_000_000  # cells written as CSV, JSON or NetCDF


def write_rows(path: str | Path, header: Iterable[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table, numbers with all their digits. Raises InputError where the place cannot be written."""
    with writing(path), open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(header)
        table.writerows(rows)


def write_columns(path: str | Path, columns: Mapping[str, NDArray[Any]]) -> None:
    """Write arrays of one size side by side, each in the order of storage. Raises InputError."""
    write_rows(path, columns, zip(*(column.ravel().tolist() for column in columns.values()), strict=True))


def places_of(dataset: xarray.Dataset) -> dict[str, NDArray[Any]]:
    """Where every cell is: the values of the axes, fastest first, and of coordinates that samples have; each of all
    cells."""
    dims = dims_of(dataset)
    columns = {}
    for name in reversed(dims):
        shape = [-1 if dim == name else 1 for dim in dims]
        columns[name] = np.broadcast_to(dataset[name].values.reshape(shape), dataset["status"].shape)
    for name in map(str, dataset.coords):
        if dataset[name].dims == dims and name not in dims:
            columns[name] = dataset[name].values
    return columns


def dims_of(dataset: xarray.Dataset) -> tuple[str, ...]:
    """Names of the axes of the cells, slowest first."""
    return tuple(map(str, dataset["status"].dims))


def check_small(dataset: xarray.Dataset) -> None:
    """Raise InputError for more cells than a table holds."""
    if (cells := dataset["status"].size) > LARGEST_TABLE:
        raise InputError(f"{cells} cells: tables hold up to {LARGEST_TABLE}. Give a name that ends in .zarr.")


def save_netcdf(dataset: xarray.Dataset, path: str | Path) -> None:
    """One NetCDF file, whole or not at all. Raises InputError."""
    check_small(dataset)
    place = Path(path)
    part = place.with_name(f".{place.name}.part")
    try:
        with writing(path):
            dataset.to_netcdf(part, engine="scipy")
            part.replace(place)
    except InputError:
        part.unlink(missing_ok=True)
        raise
