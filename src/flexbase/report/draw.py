"""Pictures and pages of maps that were written earlier."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from flexbase.errors import InputError, nearest_name
from flexbase.report.plot import save_plot
from flexbase.sweeps import difference, open_dataset
from flexbase.sweeps.answers.chart import thinned

if TYPE_CHECKING:
    import xarray


def draw(
    file: str | Path, out: str | Path, *, before: str | Path | None = None, at: Mapping[str, float] | None = None
) -> xarray.Dataset:
    """Draw a sweep, a hardware map or a Monte Carlo study from its file; what was drawn.

    file : a .zarr store or a .nc file; out : a picture (.png .svg .pdf) or, of sweeps, a page (.html)
    before : another one of the same cells: drawn is what changes from it; at : axis -> value, whose nearest cells count
    Large stores are thinned evenly, not read whole. Raises InputError, MissingExtra.
    """
    found = _chosen(file, at or {})
    if before is not None:
        found = difference(thinned(_chosen(before, at or {})), thinned(found))
    save_plot(found, out)
    return found


def _chosen(file: str | Path, at: Mapping[str, float]) -> xarray.Dataset:
    """The cells nearest to the values given. Raises InputError."""
    dataset = open_dataset(file)
    for name, value in at.items():
        dims = dataset["status"].dims
        if name not in dims:
            raise InputError(f'at: no axis "{name}". {nearest_name(name, map(str, dims))}')
        dataset = dataset.sel({name: value}, method="nearest")
    return dataset
