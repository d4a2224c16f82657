"""The one runner of questions: all cells, block by block, in memory or in a store that goes on where it was."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexbase.errors import InputError
from flexbase.requests import Progress
from flexbase.sweeps.cells.axis import boxes, extent, region
from flexbase.sweeps.cells.domain import Domain
from flexbase.sweeps.engine.executors import run_blocks
from flexbase.sweeps.engine.job import Job
from flexbase.sweeps.engine.question import Question
from flexbase.sweeps.kept.layout import empty, fields_of, to_dataset
from flexbase.sweeps.kept.opened import open_dataset
from flexbase.sweeps.kept.store import identity, open_store
from flexbase.sweeps.requests import Execution

if TYPE_CHECKING:
    import xarray

LARGEST = 20_000_000  # cells that are kept in memory; more need a store


def run(
    question: Question,
    domain: Domain,
    block: tuple[int, ...],
    execution: Execution,
    progress: Progress,
    attributes: Mapping[str, Any],
    recipe: Mapping[str, Any] | None = None,
) -> xarray.Dataset:
    """The answer to a question in every cell of a domain, the same however it is executed.

    block : cells that are answered, and kept, together; an interruption costs one, or as many as run side by side
    recipe : all that the answer depends on, for those who keep it
    progress : called with "cells", the cells done and all of them
    Raises InputError, MissingExtra.
    """
    total, store = _size(domain.shape), execution.store
    if store is None and total > LARGEST:
        raise InputError(
            f"shape: {total} cells; up to {LARGEST} are kept in memory. Give a store (--out NAME.zarr) for more."
        )
    fields, said = fields_of(question, domain, block), {**attributes, **identity(recipe or {})}
    job = Job(question, domain, None if store is None else Path(store))
    rest, arrays = list(boxes(domain.shape, block)), {}
    if job.store is None:
        arrays = empty(fields)
    else:
        finished = open_store(job.store, recipe or {}, fields, said, execution.resume).finished()
        rest = [work for work in rest if not finished[work[0]]]
    done = total - sum(_size(extent(box)) for _, box in rest)
    progress("cells", done, total)
    whole = {one.name for one in question.columns if one.of_block}
    for (place, box), values in run_blocks(job, rest, execution):
        for name, part in values.items():
            arrays[name][place if name in whole else region(box)] = part
        done += _size(extent(box))
        progress("cells", done, total)
    return to_dataset(fields, arrays, said) if job.store is None else open_dataset(job.store)


def _size(shape: tuple[int, ...]) -> int:
    return int(np.prod(shape, dtype=np.int64))
