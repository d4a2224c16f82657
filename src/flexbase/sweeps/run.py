"""Sweep a plant: measures over joints, tip positions, parameters or samples, in blocks, resumable."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from flexbase.checks import choose
from flexbase.errors import FlexbaseWarning, InputError, MissingExtra
from flexbase.measures import MEASURES, Measure
from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Plant, check_plant
from flexbase.sweeps.caveats import check_measures
from flexbase.sweeps.cells.axis import block_shape, boxes
from flexbase.sweeps.cells.domain import RANDOM, SAMPLINGS, Grid
from flexbase.sweeps.cells.grids import Place, Range, joint_place, sample_place, tip_place
from flexbase.sweeps.engine.evaluate import AUTO, COMPILED, ENGINES, ROWS
from flexbase.sweeps.engine.executors import Result, by_dask, by_threads
from flexbase.sweeps.engine.job import Job, Work
from flexbase.sweeps.engine.question import Question
from flexbase.sweeps.kept.layout import empty, fields_of, to_dataset
from flexbase.sweeps.kept.opened import open_dataset
from flexbase.sweeps.kept.recipe import recipe_of
from flexbase.sweeps.kept.store import identity, open_store

LARGEST = 20_000_000  # cells that are kept in memory; more need a store
WORTH_COMPILING = 200_000  # cells from which a kernel gains more than the half second that it takes to make
QUICK_BLOCK, SLOW_BLOCK = 1 << 20, 1 << 14  # cells a block: compiled, or with steps in NumPy
Progress = Callable[[int, int], None]


def sweep(
    plant: Plant,
    measures: Sequence[str] = ("robustness",),
    over: str = "tip",
    shape: Sequence[int] | None = None,
    *,
    bounds: Sequence[float] | None = None,
    branch: str | None = None,
    axes: Sequence[str] = (),
    hold: Sequence[float] = (),
    vary: Mapping[str, Range] | None = None,
    loop: Asked = None,
    sampling: str = RANDOM,
    seed: int = 0,
    engine: str = AUTO,
    store: str | Path | None = None,
    resume: bool = False,
    scheduler: str | None = None,
    workers: int | None = None,
    progress: Progress = lambda done, total: None,
) -> Any:
    """Measures over many configurations, the base at its equilibrium; an `xarray.Dataset`.

    Modes are those of `real_modes`: exact for one base joint and for proportional damping. Gravity's sag and stiffness
    and joint friction are left out.

    over : "tip" (task rows, by inverse kinematics), "joints" (a box of arm joints), or "samples" of such a box
    shape : cells along each axis, in the order of `axes`; for samples, how many
    bounds : low, high of each axis in turn; the arm's reach, or a full turn, if left out
    axes : task rows or arm joints that vary; the first two rows, or the elbow and the joint before, if left out
    hold : over tip, the other task rows; else all n arm joints, used where they do not vary
    vary : a parameter's name -> (low, high, count), a further axis each; names in `PARAMETERS`, or of one
        joint, such as `stiffness.q1`
    sampling, seed : "random" or "halton"
    engine : "compiled", "rows" (NumPy, no warm-up), or "auto", by the number of cells
    store : a Zarr folder that blocks are written to as they finish; `resume` goes on with one that was interrupted
    scheduler, workers : run the blocks on a Dask cluster, running or started here
    progress : called with the cells done and all cells
    Raises InputError, MissingExtra. A cell that cannot be judged gets a status instead of values.
    """
    check_plant(plant)
    names = [measures] if isinstance(measures, str) else list(measures)
    chosen = tuple(choose("measure", name, MEASURES) for name in dict.fromkeys(names))
    check_measures(plant, chosen, "map")
    place = _place(plant, over, shape, bounds, branch, axes, hold, dict(vary or {}), sampling, seed)
    E = loop_on(plant.arm, loop).E
    if store is None:
        chosen += _companions(plant, chosen)
    question = _question(plant, chosen, place, tuple(vary or {}), E)
    total = int(np.prod(place.domain.shape, dtype=np.int64))
    if store is None and (resume or total > LARGEST):
        raise InputError(
            f"shape: {total} cells; up to {LARGEST} are kept in memory. Give a store (--out NAME.zarr) for more."
            if total > LARGEST
            else "resume: there is nothing to resume without a store. Give --out NAME.zarr."
        )
    engine = _engine(engine, question, total)
    solves = isinstance(place.domain, Grid) and place.domain.solve is not None
    quick = engine == COMPILED and not solves and not any(one.slow for one in chosen)
    block = block_shape(place.domain.shape, QUICK_BLOCK if quick else SLOW_BLOCK)
    recipe = recipe_of(question, place, engine, str(branch or plant.arm.task.branch), block)
    fields = fields_of(question, place.domain, block, names)
    attributes = {"robot": plant.name, "compensated": int(E is not None), "over": over, **identity(recipe)}
    everything = list(boxes(place.domain.shape, block))

    def run(job: Job, blocks: Sequence[Work]) -> Any:
        pooled = scheduler is not None or workers is not None
        return by_dask(job, blocks, scheduler, workers) if pooled else by_threads(job, blocks)

    job = Job(question, place.domain, engine, None if store is None else Path(store))
    if job.store is None:
        arrays = empty(fields)
        for (_, box), values in _reported(run(job, everything), progress, 0, total):
            region = tuple(slice(begin, end) for begin, end in box)
            for name, part in values.items():
                arrays[name][region] = part
        return to_dataset(fields, arrays, attributes)
    kept = open_store(job.store, recipe, fields, attributes, resume)
    finished = kept.finished()
    rest = [work for work in everything if not finished[work[0]]]
    done = total - sum(_cells(work) for work in rest)
    for _ in _reported(run(job, rest), progress, done, total) if rest else ():
        pass
    return open_dataset(job.store)


def _reported(results: Any, progress: Progress, done: int, total: int) -> Any:
    result: Result
    progress(done, total)
    for result in results:
        done += _cells(result[0])
        progress(done, total)
        yield result


def _cells(work: Work) -> int:
    return int(np.prod([end - begin for begin, end in work[1]], dtype=np.int64))


def _engine(wanted: str, question: Question, total: int) -> str:
    """The engine that will be used, made ready: a missing package shows before any work."""
    if wanted not in ENGINES:
        raise InputError(f'engine: "{wanted}" is unknown. Give one of {", ".join(ENGINES)}.')
    if wanted == ROWS or (wanted == AUTO and total < WORTH_COMPILING):
        return ROWS
    try:
        from flexbase.sweeps.engine.evaluate import compiled

        compiled(question)
    except MissingExtra as missing:
        if wanted == COMPILED:
            raise
        warnings.warn(f"{missing} Until then maps run on NumPy, ten times slower.", FlexbaseWarning, stacklevel=3)
        return ROWS
    return COMPILED


def _question(
    plant: Plant, chosen: tuple[Measure, ...], place: Place, parameters: tuple[str, ...], E: np.ndarray | None
) -> Question:
    return Question(plant.arm, chosen, place.varied, place.held, parameters, E, place.planar, place.side)


def _place(
    plant: Plant,
    over: str,
    shape: Sequence[int] | None,
    bounds: Sequence[float] | None,
    branch: str | None,
    axes: Sequence[str],
    hold: Sequence[float],
    vary: Mapping[str, Range],
    sampling: str,
    seed: int,
) -> Place:
    if over == "tip":
        return tip_place(plant, shape, bounds, axes, hold, branch, vary)
    if over == "joints":
        return joint_place(plant, shape, bounds, axes, hold, vary)
    if over == "samples":
        if sampling not in SAMPLINGS:
            raise InputError(f'sampling: "{sampling}" is unknown. Give one of {", ".join(SAMPLINGS)}.')
        return sample_place(plant, shape, bounds, axes, hold, vary, sampling, seed)
    raise InputError(f'over: "{over}" is unknown. Give "tip", "joints" or "samples".')


def _companions(plant: Plant, chosen: Sequence[Measure]) -> tuple[Measure, ...]:
    """Measures that change their sign where one of the chosen only touches zero: pictures draw it by them."""
    arm = plant.arm
    lines = [MEASURES[one.zero_line] for one in chosen if one.zero_line]
    return tuple(line for line in lines if line not in chosen and not line.needs(arm.m, arm.n, arm.k))
