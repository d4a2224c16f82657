"""A plane of a sweep, ready to be drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.measures import MEASURES
from flexbase.sweep.axis import Axis
from flexbase.sweep.summary import measures_of

LARGEST = 2000  # cells along an axis that are drawn: more are thinned out evenly


@dataclass(frozen=True, eq=False)
class Chart:
    """Measures over a plane; the first axis runs along columns (x), the second along rows (y).

    values : a measure's name -> shape (rows, columns), or (rows, columns, m) for measures of each mode; NaN unless OK
    status : shape (rows, columns), a key of `STATUS`
    zero_lines : for measures that only touch zero, a companion (same shape) that changes its sign near 0 there
    """

    robot: str
    axes: tuple[Axis, Axis]
    values: dict[str, Array]
    status: NDArray[np.int8]
    compensated: bool
    zero_lines: dict[str, Array]

    def count(self, status: int) -> int:
        """How many cells have a status."""
        return int(np.count_nonzero(self.status == status))


def chart_of(dataset: Any) -> Chart:
    """The plane of a sweep over two axes; of more, choose with `isel` first. Raises InputError."""
    plane = dataset.squeeze(drop=True) if dataset["status"].ndim > 2 else dataset
    dims = plane["status"].dims
    if len(dims) != 2:
        raise InputError(
            f"plot: this sweep has {len(dims)} axes ({', '.join(dims)}), a picture has two. Choose values of the others "
            "with dataset.isel or dataset.sel."
        )
    plane = plane.isel({dim: slice(None, None, -(-plane.sizes[dim] // LARGEST)) for dim in dims}).load()
    axes = tuple(Axis(dim, plane[dim].attrs["units"], plane[dim].values) for dim in reversed(dims))
    values = {name: plane[name].values for name in measures_of(plane)}
    lines = {name: MEASURES[name].zero_line for name in values}
    zero_lines = {name: plane[line].values for name, line in lines.items() if line in plane}
    return Chart(
        str(plane.attrs["robot"]),
        (axes[0], axes[1]),
        values,
        plane["status"].values,
        bool(plane.attrs["compensated"]),
        zero_lines,
    )
