"""One block of a sweep: inputs, answers, and where they go. What a thread or a worker is given."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from flexbase.checks import Array
from flexbase.sweeps.cells.axis import Box, extent
from flexbase.sweeps.cells.domain import Domain, Samples
from flexbase.sweeps.engine.evaluate import COMPILED, Engine, compiled
from flexbase.sweeps.engine.question import Question
from flexbase.sweeps.engine.status import UNREACHABLE
from flexbase.sweeps.kept.store import Store

Work = tuple[tuple[int, ...], Box]  # a block's place in the grid of blocks, and its cells


@dataclass(frozen=True, eq=False)
class Job:
    """A sweep as its blocks see it; `store` is where they are written, or None to hand them back."""

    question: Question
    domain: Domain
    engine: str
    store: Path | None = None

    def run(self, work: Work) -> Mapping[str, Array]:
        """The arrays of a block, none if they were written."""
        place, box = work
        arrays = self._answers(box)
        if self.store is None:
            return arrays
        _opened(self.store).write(place, box, arrays)
        return {}

    def _answers(self, box: Box) -> dict[str, Array]:
        inputs, reached = self.domain.inputs(box)
        engine = Engine(self.question) if self.engine != COMPILED else _compiled(self.question.recipe, self)
        shape = extent(box)
        if reached is None:
            block = engine.run(inputs, threads=1)
            status, values = block.status, block.values
        else:
            cells = np.flatnonzero(reached)
            block = engine.run(np.ascontiguousarray(inputs[:, cells]), threads=1)
            status = np.full(reached.size, UNREACHABLE, dtype=np.int8)
            status[cells] = block.status
            values = {}
            for name, part in block.values.items():
                values[name] = np.full((reached.size, *part.shape[1:]), np.nan)
                values[name][cells] = part
        drawn = dict(zip(self.domain.names, inputs, strict=True)) if isinstance(self.domain, Samples) else {}
        folded = {name: part.reshape(*shape, *part.shape[1:]) for name, part in {**drawn, **values}.items()}
        return {"status": status.reshape(shape), **folded}


_ENGINES: dict[str, Engine] = {}


def _compiled(recipe: str, job: Job) -> Engine:
    """One kernel a process and recipe: machine code cannot be sent to a worker, but its recipe can."""
    if recipe not in _ENGINES:
        _ENGINES[recipe] = compiled(job.question)
    return _ENGINES[recipe]


@lru_cache(maxsize=8)
def _opened(path: Path) -> Store:
    return Store(path)
