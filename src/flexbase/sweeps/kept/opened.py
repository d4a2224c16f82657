"""Sweeps that were written earlier, read back."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexbase.cautions import caution
from flexbase.errors import InputError, import_extra
from flexbase.sweeps.kept.store import FINISHED, RECIPE

if TYPE_CHECKING:
    import xarray


def open_dataset(path: str | Path) -> xarray.Dataset:
    """A sweep's Zarr store or NetCDF file as an `xarray.Dataset`; a store's values are read when they are used.

    Warns where a store is unfinished: the missing cells hold NaN. Raises InputError, MissingExtra.
    """
    import xarray

    place = Path(path)
    try:
        if place.is_file():
            found = xarray.load_dataset(place, engine="scipy")
        else:
            import_extra("zarr", "maps")
            found = xarray.open_zarr(place, consolidated=False, chunks=None)
            _warn_unfinished(place, found[FINISHED].values)
            found = found[["status", *_measures(found)]]
        _ = found["status"].attrs["flag_meanings"], found.attrs["robot"]  # KeyError where there are none
    except (OSError, ValueError, KeyError, TypeError) as fault:
        raise InputError(
            f"{path}: is no sweep of flexbase's. Give a .zarr folder or a .nc file that flexbase sweep wrote."
        ) from fault
    return found


def _measures(found: xarray.Dataset) -> list[str]:
    """Names of a store's measures in the order of its recipe: a folder has none."""
    recipe = json.loads(found.attrs[RECIPE])["measures"]
    rest = [name for name in found.data_vars if name not in (*recipe, "status", FINISHED)]
    return [*(name for name in recipe if name in found), *rest]


def _warn_unfinished(place: Path, finished: np.ndarray) -> None:
    if missing := int(np.count_nonzero(finished == 0)):
        caution(f"{place}: {missing} of {finished.size} blocks are missing and hold no values. Go on with --resume.")
