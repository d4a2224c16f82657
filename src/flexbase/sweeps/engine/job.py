"""One block of cells: inputs, answers, and where they go. What a thread, a process or a worker is given."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.sweeps.cells.axis import Box, extent
from flexbase.sweeps.cells.domain import Domain
from flexbase.sweeps.engine.question import Question
from flexbase.sweeps.engine.status import UNREACHABLE
from flexbase.sweeps.kept.store import Store

Work = tuple[tuple[int, ...], Box]  # a block's place in the grid of blocks, and its cells


@dataclass(frozen=True, eq=False)
class Job:
    """A question as its blocks see it; `store` is where they are written, or None to hand them back."""

    question: Question
    domain: Domain
    store: Path | None = None

    def run(self, work: Work) -> Mapping[str, NDArray[Any]]:
        """The arrays of a block, none if they were written."""
        place, box = work
        arrays = self._answers(box)
        if self.store is None:
            return arrays
        _opened(self.store).write(place, box, arrays)
        return {}

    def _answers(self, box: Box) -> dict[str, NDArray[Any]]:
        inputs, reached = self.domain.inputs(box)
        status, values = self._asked(inputs, reached)
        drawn = dict(zip(self.domain.drawn, inputs, strict=False))
        shape, whole = extent(box), {one.name for one in self.question.columns if one.of_block}
        folded = {
            name: part if name in whole else part.reshape((*shape, *part.shape[1:]))
            for name, part in {**drawn, **values}.items()
        }
        return {"status": status.reshape(shape), **folded}

    def _asked(self, inputs: Array, reached: NDArray[np.bool_] | None) -> tuple[NDArray[np.int8], Mapping[str, Any]]:
        """Answers of all cells, where only some are reached."""
        if reached is None:
            block = self.question.answer(inputs)
            return block.status, block.values
        cells = np.flatnonzero(reached)
        block = self.question.answer(np.ascontiguousarray(inputs[:, cells]))
        status = np.full(reached.size, UNREACHABLE, dtype=np.int8)
        status[cells] = block.status
        values = {}
        for one in self.question.columns:
            part = values[one.name] = block.values[one.name]
            if not one.of_block:
                values[one.name] = np.full((reached.size, *part.shape[1:]), one.missing, dtype=part.dtype)
                values[one.name][cells] = part
        return status, values


@lru_cache(maxsize=8)
def _opened(path: Path) -> Store:
    return Store(path)
