"""Blocks on disk as they finish: a Zarr store that a killed sweep can be resumed from."""

from __future__ import annotations

import errno
import json
import os
import shutil
import tempfile
from collections.abc import Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.errors import InputError, import_extra
from flexbase.sweeps.cells.axis import Box, region
from flexbase.sweeps.kept.recipe import differences, digest

RECIPE = "flexbase_recipe"
FINISHED = "finished_blocks"


class Field(NamedTuple):
    """One array of a sweep: dtype, names of its dimensions, shape, blocks and attributes."""

    dtype: str
    dims: tuple[str, ...]
    shape: tuple[int, ...]
    block: tuple[int, ...]
    attributes: Mapping[str, Any]
    coordinate: bool = False
    values: NDArray[Any] | None = None  # of axes, written at once


class Store:
    """A sweep's folder. A block's values are written first, then its mark in `finished_blocks`.."""

    def __init__(self, path: Path) -> None:
        self.path = path
        zarr = import_extra("zarr", "maps")
        self._group = zarr.open_group(path, mode="r+")

    def finished(self) -> NDArray[np.bool_]:
        """Which blocks are complete, in the grid of blocks."""
        return np.asarray(self._group[FINISHED][...], dtype=bool)

    def write(self, place: tuple[int, ...], box: Box, values: Mapping[str, Array]) -> None:
        """Write a block's arrays, then mark it. Raises InputError where the disk is full or gone."""
        with _disk(self.path, "finished blocks are kept; make room and go on with --resume"):
            for name, part in values.items():
                self._group[name][region(box)] = part
            self._group[FINISHED][place] = 1


def open_store(
    path: Path, recipe: Mapping[str, Any], fields: Mapping[str, Field], attributes: Mapping[str, Any], resume: bool
) -> Store:
    """A new store, or with `resume` the one that is there, if it was written by the same recipe.

    A missing or half-created store is started. Raises InputError where another recipe's, or anything else, is there.
    """
    if path.exists() and not _is_unborn(path):
        if not resume:
            raise InputError(f"{path}: already exists. Go on with --resume, or give another name.")
        _check_recipe(path, recipe)
        with _disk(path, "give a folder that can be written"):
            return Store(path)
    with _disk(path, "give a place that can be written"):
        return _create(path, fields, attributes)


def _create(path: Path, fields: Mapping[str, Field], attributes: Mapping[str, Any]) -> Store:
    """Made under another name and renamed: a store is there whole or not at all."""
    zarr = import_extra("zarr", "maps")
    for left in path.parent.glob(f".{path.name}.*.new"):  # of a start that was killed
        shutil.rmtree(left, ignore_errors=True)
    place = Path(tempfile.mkdtemp(prefix=f".{path.name}.", suffix=".new", dir=path.parent))
    try:
        group = zarr.open_group(place, mode="w", zarr_format=3)
        for name, field in fields.items():
            array = group.create_array(
                name,
                shape=field.shape,
                chunks=field.block,
                dtype=field.dtype,
                fill_value=0 if field.dtype != "float64" else float("nan"),
                compressors=zarr.codecs.BloscCodec(cname="lz4", clevel=3, shuffle="shuffle"),
                dimension_names=field.dims,
                attributes=dict(field.attributes),
            )
            if field.values is not None:
                array[...] = field.values
        group.attrs.update(attributes)
        if path.exists():
            shutil.rmtree(path)
        place.chmod(0o777 & ~_umask())
        os.rename(place, path)
    except BaseException:
        shutil.rmtree(place, ignore_errors=True)
        raise
    return Store(path)


def identity(recipe: Mapping[str, Any]) -> dict[str, Any]:
    """Attributes that a sweep carries wherever it is kept."""
    return {RECIPE: json.dumps(recipe, sort_keys=True), "flexbase_recipe_digest": digest(recipe)}


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def read_recipe(path: Path) -> dict[str, Any] | None:
    """The recipe of a store, or None where there is none that can be read."""
    try:
        found = json.loads((path / "zarr.json").read_text("utf-8"))["attributes"][RECIPE]
        return dict(json.loads(found))
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _is_unborn(path: Path) -> bool:
    """Whether a folder holds no sweep yet: empty, or metadata alone that was never completed."""
    if not path.is_dir() or read_recipe(path) is not None:
        return False
    return all(file.name == "zarr.json" or file.is_dir() for file in path.rglob("*"))


def _check_recipe(path: Path, recipe: Mapping[str, Any]) -> None:
    there = read_recipe(path)
    if there is None:
        raise InputError(f"{path}: is no sweep of flexbase's. Give another name.")
    if digest(there) != digest(recipe):
        raise InputError(
            f"{path}: was written by another recipe; these differ: {differences(there, recipe)}. Nothing was changed. "
            "Give another name, or the options that it was started with."
        )


@contextmanager
def _disk(path: Path, mend: str) -> Any:
    try:
        yield
    except OSError as fault:
        full = fault.errno in (errno.ENOSPC, errno.EDQUOT)
        what = "the disk is full" if full else f"cannot be written ({fault.strerror or fault})"
        raise InputError(f"{path}: {what}; {mend}.") from fault
