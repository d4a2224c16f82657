"""The arrays of an answer: names, dimensions, units and what their zero means."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from flexbase.sweeps.cells.domain import Domain
from flexbase.sweeps.engine.question import MODE, Question
from flexbase.sweeps.engine.status import flags
from flexbase.sweeps.kept.store import FINISHED, Field

if TYPE_CHECKING:
    import xarray


def fields_of(question: Question, domain: Domain, block: tuple[int, ...]) -> dict[str, Field]:
    """Coordinates, status, columns and the marks of finished blocks."""
    dims, shape = tuple(axis.name for axis in domain.axes), domain.shape
    counts = tuple(-(-size // step) for size, step in zip(shape, block, strict=True))
    blocks, one_each = tuple(f"block_{dim}" for dim in dims), (1,) * len(counts)
    fields: dict[str, Field] = {}
    for axis in domain.axes:
        whole = axis.values.shape
        fields[axis.name] = Field("float64", (axis.name,), whole, whole, {"units": axis.unit}, True, axis.values)
    for name, unit in domain.drawn.items():
        fields[name] = Field("float64", dims, shape, block, {"units": unit}, True)
    modes = {one.more[1] for one in question.columns if one.more and one.more[0] == MODE}
    for count in modes:
        said = {"long_name": "vibration mode, slowest first"}
        fields[MODE] = Field("int64", (MODE,), (count,), (count,), said, True, np.arange(1, count + 1))
    fields["status"] = Field("int8", dims, shape, block, flags(question.meanings))
    for one in question.columns:
        of, cells, each = (blocks, counts, one_each) if one.of_block else (dims, shape, block)
        more, size = ((one.more[0],), (one.more[1],)) if one.more else ((), ())
        fields[one.name] = Field(one.dtype, of + more, cells + size, each + size, one.told)
    fields[FINISHED] = Field("int8", blocks, counts, one_each, {})
    return fields


def empty(fields: Mapping[str, Field]) -> dict[str, NDArray[Any]]:
    """The same arrays in memory: coordinates filled in, all else to be."""
    return {
        name: np.array(field.values) if field.values is not None else np.zeros(field.shape, field.dtype)
        for name, field in fields.items()
        if name != FINISHED
    }


def to_dataset(
    fields: Mapping[str, Field], arrays: Mapping[str, NDArray[Any]], attributes: Mapping[str, Any]
) -> xarray.Dataset:
    """Arrays in memory as a dataset."""
    import xarray

    variables = {name: (fields[name].dims, array, dict(fields[name].attributes)) for name, array in arrays.items()}
    coordinates = {name: variable for name, variable in variables.items() if fields[name].coordinate}
    data = {name: variable for name, variable in variables.items() if not fields[name].coordinate}
    return xarray.Dataset(data, coordinates, attributes)
