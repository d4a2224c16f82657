"""The outcome of a sweep over two axes: measures and a status for every cell."""

from __future__ import annotations

import csv
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.errors import InputError, import_extra
from flexbase.measures import MEASURES
from flexbase.plant import Plant

OK, UNREACHABLE, SINGULAR, INDEFINITE = range(4)
STATUS = {
    OK: "ok",
    UNREACHABLE: "out of reach",
    SINGULAR: "singular arm",
    INDEFINITE: "M - E not positive definite",
}


@dataclass(frozen=True, eq=False)
class Axis:
    """One axis of a chart: a task row or an arm joint."""

    name: str
    unit: str
    values: Array


@dataclass(frozen=True, eq=False)
class Chart:
    """Measures over a grid; the first axis runs along columns (x), the second along rows (y).

    values : a measure's name -> shape (rows, columns), or (rows, columns, m) for measures of each mode; NaN unless OK
    status : shape (rows, columns), a key of `STATUS`
    zero_lines : for measures that only touch zero, a companion (same shape) that changes its sign near 0 there
    """

    plant: Plant
    axes: tuple[Axis, Axis]
    values: dict[str, Array]
    status: NDArray[np.int8]
    compensated: bool
    zero_lines: dict[str, Array] = field(default_factory=dict, repr=False)

    def count(self, status: int) -> int:
        """How many cells have a status."""
        return int(np.count_nonzero(self.status == status))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers; cells without a value hold None."""
        return {
            "robot": self.plant.name,
            "compensated": self.compensated,
            "axes": [{"name": axis.name, "unit": axis.unit, "values": axis.values.tolist()} for axis in self.axes],
            "measures": {
                name: {"unit": MEASURES[name].unit, "values": _with_none(values)}
                for name, values in self.values.items()
            },
            "status": self.status.tolist(),
            "status_codes": {str(code): meaning for code, meaning in STATUS.items()},
        }

    def to_xarray(self) -> Any:
        """The same as an `xarray.Dataset`. Needs the extra "maps"."""
        xarray = import_extra("xarray", "maps")
        first, second = self.axes
        coordinates = {axis.name: (axis.name, axis.values, {"units": axis.unit}) for axis in (second, first)}
        plane = (second.name, first.name)
        data: dict[str, Any] = {
            name: ((*plane, "mode") if values.ndim == 3 else plane, values, {"units": MEASURES[name].unit})
            for name, values in self.values.items()
        }
        meanings = {"flag_values": list(STATUS), "flag_meanings": list(STATUS.values())}
        data["status"] = (plane, self.status, meanings)
        return xarray.Dataset(data, coordinates, {"robot": self.plant.name})

    def save_csv(self, path: str | Path) -> None:
        """One line a cell. Raises InputError where the place cannot be written."""
        first, second = self.axes
        columns: dict[str, np.ndarray] = {first.name: np.broadcast_to(first.values, self.status.shape)}
        columns[second.name] = np.broadcast_to(second.values[:, None], self.status.shape)
        for name, values in self.values.items():
            if values.ndim == 3:
                columns |= {f"{name}_{i + 1}": values[..., i] for i in range(values.shape[-1])}
            else:
                columns[name] = values
        columns["status"] = self.status
        try:
            with open(path, "w", newline="", encoding="utf-8") as file:
                table = csv.writer(file)
                table.writerow(columns)
                table.writerows(zip(*(column.ravel().tolist() for column in columns.values()), strict=True))
        except OSError as fault:
            raise InputError(
                f"{path}: cannot be written ({fault.strerror}). Give a file in an existing folder."
            ) from fault

    def summary(self) -> str:
        """A line on the cells and one on each measure."""
        cells = ", ".join(f"{self.count(code)} {meaning}" for code, meaning in STATUS.items() if self.count(code))
        lines = [f"{self.plant.name}: {self.status.size} cells, {cells}"]
        for name, values in self.values.items():
            known = values[np.isfinite(values)]
            extent = f"{known.min():.6g} to {known.max():.6g}" if known.size else "no value"
            lines.append(f"  {name}: {extent} {MEASURES[name].unit}")
        return "\n".join(lines)


def _with_none(values: Array) -> Any:
    if values.ndim:
        return [_with_none(part) for part in values]
    return float(values) if np.isfinite(values) else None
