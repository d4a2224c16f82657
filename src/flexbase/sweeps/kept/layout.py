"""The arrays of a sweep's answer: names, dimensions, units and what their zero means."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np

from flexbase.sweeps.cells.domain import Domain, Samples
from flexbase.sweeps.engine.question import Question
from flexbase.sweeps.engine.status import STATUS, flags
from flexbase.sweeps.kept.store import FINISHED, Field

MODE = "mode"
MEASURED = "measured"  # attribute of a measure that no registry knows, such as a verdict's
COMPANION = "companion"  # attribute of measures that nobody asked for: they draw the zero line of another


def fields_of(question: Question, domain: Domain, block: tuple[int, ...], asked: Collection[str]) -> dict[str, Field]:
    """Coordinates, status, measures and the marks of finished blocks; measures that were not asked for are marked."""
    dims, shape = tuple(axis.name for axis in domain.axes), domain.shape
    fields: dict[str, Field] = {}
    for axis in domain.axes:
        whole = axis.values.shape
        fields[axis.name] = Field("float64", (axis.name,), whole, whole, {"units": axis.unit}, True, axis.values)
    if isinstance(domain, Samples):
        for name, unit in zip(domain.names, domain.units, strict=True):
            fields[name] = Field("float64", dims, shape, block, {"units": unit}, True)
    if any(one.per_mode for one in question.measures):
        numbers = np.arange(1, question.arm.m + 1)
        said = {"long_name": "vibration mode, slowest first"}
        fields[MODE] = Field("int64", (MODE,), numbers.shape, numbers.shape, said, True, numbers)
    fields["status"] = Field("int8", dims, shape, block, flags(STATUS))
    for one in question.measures:
        said = {"units": one.unit, "long_name": one.purpose}
        said |= {"zero_is": one.zero_is} if one.zero_is else {}
        said |= {} if one.name in asked else {COMPANION: "1"}
        modes = (question.arm.m,) if one.per_mode else ()
        fields[one.name] = Field("float64", (*dims, MODE) if modes else dims, shape + modes, block + modes, said)
    counts = tuple(-(-size // step) for size, step in zip(shape, block, strict=True))
    fields[FINISHED] = Field("int8", tuple(f"block_{dim}" for dim in dims), counts, (1,) * len(counts), {})
    return fields


def empty(fields: dict[str, Field]) -> dict[str, np.ndarray]:
    """The same arrays in memory: coordinates filled in, all else to be."""
    return {
        name: np.array(field.values) if field.values is not None else np.zeros(field.shape, field.dtype)
        for name, field in fields.items()
        if name != FINISHED
    }


def to_dataset(fields: dict[str, Field], arrays: dict[str, np.ndarray], attributes: dict[str, Any]) -> Any:
    """An `xarray.Dataset` of arrays in memory."""
    import xarray

    variables = {name: (fields[name].dims, array, dict(fields[name].attributes)) for name, array in arrays.items()}
    coordinates = {name: variable for name, variable in variables.items() if fields[name].coordinate}
    data = {name: variable for name, variable in variables.items() if not fields[name].coordinate}
    return xarray.Dataset(data, coordinates, attributes)
