"""What is asked of every cell: a traced formula, or something that is asked pose by pose."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array

MODE = "mode"  # the further axis of measures that each vibration mode has a value of
MEASURED = "measured"  # attribute of a measure that no registry knows, such as a verdict's
COMPANION = "companion"  # attribute of measures that nobody asked for: they draw the zero line of another


class Column(NamedTuple):
    """One array of an answer.

    told : its attributes, such as units
    more : name and size of a further axis, such as ("mode", m), or None for one value a cell
    of_block : it has that further axis alone, a row for each block, whatever the cells
    """

    name: str
    told: Mapping[str, Any]
    more: tuple[str, int] | None = None
    dtype: str = "float64"
    of_block: bool = False

    @property
    def missing(self) -> float | int:
        """What stands where there is no value."""
        return np.nan if self.dtype == "float64" else 0


class Block(NamedTuple):
    """Answers for some configurations.

    values : a column's name -> shape (cells,), or (cells, size) with a further axis, or (size,) of the block
    """

    values: Mapping[str, NDArray[Any]]
    status: NDArray[np.int8]


class Question(Protocol):
    """What the runner of blocks needs; it is sent to processes, so it can be pickled.

    meanings : of its status codes; recipe : what its answers depend on beside the cells, as plain JSON values
    threads : whether threads of one process answer it side by side
    """

    @property
    def columns(self) -> tuple[Column, ...]: ...

    @property
    def meanings(self) -> Mapping[int, str]: ...

    @property
    def recipe(self) -> Mapping[str, Any]: ...

    @property
    def threads(self) -> bool: ...

    def answer(self, inputs: Array) -> Block:
        """Answers for inputs of shape (inputs, cells)."""
        ...
