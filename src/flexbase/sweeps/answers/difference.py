"""What changes between two sweeps of the same cells."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.sweeps.answers.angles import short_way
from flexbase.sweeps.answers.summary import measures_of
from flexbase.sweeps.answers.tables import dims_of
from flexbase.sweeps.engine.status import CHANGED, GAINED, LOST, OK, STATUS, flags

if TYPE_CHECKING:
    import xarray


LARGEST = 20_000_000  # cells
SAME = 1e-12  # of an axis' largest value: coordinates that differ by less are equal


def difference(before: xarray.Dataset, after: xarray.Dataset) -> xarray.Dataset:
    """After minus before in every cell, of the measures that both have; an `xarray.Dataset` of a sweep's form.

    Assumes the same axes with the same values. A measure has a value where both have one. Angles differ by the shorter
    way round. `status` is 0 where both are ok; 5, "ok before only", or 6, "ok after only", where they disagree;
    otherwise it is that of `after`.
    before, after : what `sweep` or `open_dataset` returned, such as without and with a compensator
    Raises InputError where the cells differ, no measure is common, or there are more cells than memory holds.
    """
    _check_same_cells(before, after)
    if after["status"].size > LARGEST:
        raise InputError(
            f"difference: {after['status'].size} cells; up to {LARGEST} are compared in memory. Thin both in the same "
            f"way, such as dataset.isel({after['status'].dims[-1]}=slice(None, None, 10))."
        )
    common = [name for name in measures_of(before) if name in measures_of(after)]
    if not common:
        raise InputError(
            f"difference: before has {', '.join(measures_of(before))}, after has {', '.join(measures_of(after))}. "
            "Sweep a measure in both."
        )
    found = after.drop_vars([name for name in after.data_vars if name not in common])
    for name in common:
        old, new = before[name], after[name].transpose(*before[name].dims)
        values = short_way(name, _change(old.values, new.values))
        said = {"units": new.attrs["units"], "long_name": f"change of {name}", "zero_is": "no change"}
        found[name] = (old.dims, values, said)
    then, now = before["status"], after["status"].transpose(*before["status"].dims)
    status = np.where(now == OK, np.where(then == OK, OK, GAINED), np.where(then == OK, LOST, now)).astype(np.int8)
    found["status"] = (then.dims, status, flags({**STATUS, **CHANGED}))
    recipe = before.attrs.get("flexbase_recipe", "")
    return found.assign_attrs(difference=_words(before, after), flexbase_recipe_before=recipe)


def _check_same_cells(before: xarray.Dataset, after: xarray.Dataset) -> None:
    for dataset in (before, after):
        if "status" not in dataset or not measures_of(dataset):
            raise InputError("difference: one of the two holds no sweep. Give what flexbase.sweeps returned.")
    dims = dims_of(before)
    if set(dims) != set(after["status"].dims):
        raise InputError(
            f"difference: before has the axes {', '.join(dims)}, after {', '.join(dims_of(after))}. "
            "Sweep the same ones."
        )
    drawn = [name for name in before.coords if before[name].dims == dims and name in after.coords and name not in dims]
    for name in (*dims, *drawn):
        old, new = before[name].values, after[name].values
        if old.shape != new.shape or np.abs(old - new).max() > SAME * np.abs(old).max():
            raise InputError(
                f"difference: {name} has {_extent(old)} before and {_extent(new)} after. Give both sweeps the same "
                "bounds and shape."
            )


def _extent(values: Array) -> str:
    return f"{values.size} values from {values.min():.6g} to {values.max():.6g}"


def _change(old: Array, new: Array) -> Array:
    """None between two infinite values."""
    with np.errstate(invalid="ignore"):
        return np.where(np.isinf(old) & (old == new), 0.0, new - old)


def _words(before: xarray.Dataset, after: xarray.Dataset) -> str:
    if before.attrs["robot"] != after.attrs["robot"]:
        return f"minus {before.attrs['robot']}"
    states = ("without compensator", "with compensator")
    then, now = (states[bool(dataset.attrs["compensated"])] for dataset in (before, after))
    return f"{now} minus {then}" if then != now else "after minus before"
