"""Verdicts on the loop as it runs over a plane of tips, or along a path: cell by cell, on several cores, resumable."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from flexbase.checks import Array, check_length, choose
from flexbase.errors import FlexbaseError, InputError, SingularArm, Unreachable
from flexbase.model.digest import model_digest
from flexbase.model.loop import Asked, loop_on
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Plant, check_plant
from flexbase.sampled.controller import pd_with_gain
from flexbase.sampled.figures import FIGURES
from flexbase.sampled.verdict import hardware_verdict
from flexbase.sweeps.cells.axis import block_shape, boxes, extent
from flexbase.sweeps.cells.domain import Grid
from flexbase.sweeps.cells.grids import tip_place
from flexbase.sweeps.engine.pool import in_processes
from flexbase.sweeps.engine.status import INFEASIBLE, OK, SINGULAR, UNREACHABLE, UNSTABLE, flags
from flexbase.sweeps.kept.layout import MEASURED, empty, to_dataset
from flexbase.sweeps.kept.opened import open_dataset
from flexbase.sweeps.kept.recipe import VERSIONED
from flexbase.sweeps.kept.store import FINISHED, Field, identity, open_store
from flexbase.synthesis import HARDWARE_METHODS, controller_for

MEASURES = {name: (one.unit, one.purpose) for name, one in FIGURES.items() if one.brief}
STATUS = {
    OK: "ok",
    UNREACHABLE: "out of reach",
    SINGULAR: "singular arm",
    INFEASIBLE: "no controller",
    UNSTABLE: "unstable",
}
BLOCK = 50  # cells: what a process is given, and what an interruption costs at most


class Method(NamedTuple):
    """What is judged in every cell: a method that designs anew, or task PD with one E."""

    plant: Plant
    method: str
    sensing: Sensing
    gains: Gains
    E: Array | None
    branch: str | None


def hardware_map(
    plant: Plant,
    method: str = "none",
    shape: Sequence[int] = (50, 50),
    *,
    loop: Asked = None,
    bounds: Sequence[float] | None = None,
    hold: Sequence[float] = (),
    branch: str | None = None,
    store: str | Path | None = None,
    resume: bool = False,
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Any:
    """Verdicts over the first two task rows, an `xarray.Dataset` like that of a sweep; `MEASURES` says what is in it.

    Each cell is its own pose, with a controller made for it: by the method, or task PD with a given compensator's E.
    The verdict is the brief one: without delay and lag margins. Unstable cells have that status, and the values of
    those measures that are defined there.

    hold, bounds, branch : as `flexbase.sweep` over tip takes them; store, resume : a Zarr folder, to go on with
    workers : processes, one a core if left out; progress : called with the cells done and all cells
    Raises InputError.
    """
    meant = _meant(plant, method, loop, branch)
    place = tip_place(plant, shape, bounds, (), hold, branch, {})
    axes, whole = place.domain.axes, place.domain.shape
    assert isinstance(place.domain, Grid)  # over tip it is
    held = place.held if place.planar is not None else place.domain.held
    block = block_shape(whole, BLOCK)
    fields: dict[str, Field] = {
        axis.name: Field(
            "float64", (axis.name,), axis.values.shape, axis.values.shape, {"units": axis.unit}, True, axis.values
        )
        for axis in axes
    }
    dims = tuple(axis.name for axis in axes)
    fields["status"] = Field("int8", dims, whole, block, flags(STATUS))
    for name, (unit, purpose) in MEASURES.items():
        fields[name] = Field("float64", dims, whole, block, {"units": unit, "long_name": purpose, MEASURED: "1"})
    everything = list(boxes(whole, block))
    counts = tuple(-(-size // part) for size, part in zip(whole, block, strict=True))
    recipe = _recipe(meant, {axis.name: axis.values.tolist() for axis in axes}, list(held), list(block))
    judged = f"{'given E' if meant.E is not None else f'method {method}'} at {meant.sensing.rate:g} Hz"
    said = {
        "robot": plant.name,
        "compensated": int(meant.E is not None),
        "judged": judged,
        "over": "tip",
        **identity(recipe),
    }
    kept = None
    if store is not None:
        marks = {FINISHED: Field("int8", tuple(f"block_{dim}" for dim in dims), counts, (1,) * len(counts), {})}
        kept = open_store(Path(store), recipe, {**fields, **marks}, said, resume)
        finished = kept.finished()
    elif resume:
        raise InputError("resume: there is nothing to resume without a store. Give --out NAME.zarr.")
    rest = everything if kept is None else [work for work in everything if not finished[work[0]]]
    arrays = empty(fields)
    total = int(np.prod(whole))
    done = total - sum(int(np.prod(extent(box))) for _, box in rest)
    progress(done, total)
    tasks = [(meant, _targets(plant, axes, held, box)) for _, box in rest]
    for number, (status, values) in in_processes(_verdicts, tasks, workers):
        place_, box = rest[number]
        parts = {"status": status, **dict(zip(MEASURES, values.T, strict=True))}
        folded = {name: part.reshape(extent(box)) for name, part in parts.items()}
        if kept is not None:
            kept.write(place_, box, folded)
        for name, part in folded.items():
            arrays[name][tuple(slice(*ends) for ends in box)] = part
        done += len(status)
        progress(done, total)
    return to_dataset(fields, arrays, said) if store is None else open_dataset(store)


def hardware_path(
    plant: Plant,
    tips: Sequence[Sequence[float]],
    method: str = "none",
    *,
    loop: Asked = None,
    branch: str | None = None,
    workers: int | None = None,
) -> list[dict[str, Any]]:
    """The same along a path: for each tip "tip", "status" in words, and the measures. Raises InputError."""
    meant = _meant(plant, method, loop, branch)
    targets = np.array([check_length("path", tip, plant.arm.k, "one for each task row") for tip in tips])
    parts = np.array_split(targets, max(1, len(targets) // BLOCK))
    answers: list[Any] = [None] * len(parts)
    for number, answer in in_processes(_verdicts, [(meant, part) for part in parts], workers):
        answers[number] = answer
    rows = [(code, row) for status, values in answers for code, row in zip(status, values, strict=True)]
    return [
        {"tip": tip.tolist(), "status": STATUS[int(code)], **dict(zip(MEASURES, row.tolist(), strict=True))}
        for tip, (code, row) in zip(targets, rows, strict=True)
    ]


def _meant(
    plant: Plant,
    method: str,
    loop: Asked,
    branch: str | None,
) -> Method:
    choose("method", method, HARDWARE_METHODS)
    check_plant(plant)
    meant = loop_on(plant.arm, loop)
    return Method(plant, method, meant.sensing, meant.gains, meant.E, branch)


def _targets(plant: Plant, axes: Any, held: Sequence[float], box: Any) -> Array:
    """Tip targets of a box of cells in the order of storage, shape (cells, k); `held` has all k rows."""
    ticks = [axis.values[begin:end] for axis, (begin, end) in zip(axes, box, strict=True)]
    rows = plant.arm.task.rows
    targets = np.tile(held, (int(np.prod([len(tick) for tick in ticks])), 1))
    for axis, column in zip(axes, np.meshgrid(*ticks, indexing="ij"), strict=True):
        targets[:, rows.index(axis.name)] = column.ravel()
    return np.asarray(targets)


def _verdicts(task: tuple[Method, Array]) -> tuple[np.ndarray, Array]:
    """Status and measures of some tips, shape (tips,) and (tips, measures)."""
    loop, targets = task
    status, values = np.zeros(len(targets), dtype=np.int8), np.full((len(targets), len(MEASURES)), np.nan)
    for i, target in enumerate(targets):
        try:
            pose = loop.plant.at_tip(target, loop.branch)
        except Unreachable:
            status[i] = UNREACHABLE
            continue
        except SingularArm:
            status[i] = SINGULAR
            continue
        try:
            if loop.E is not None:
                controller = pd_with_gain(pose, loop.sensing, loop.gains, loop.E, "given")
            else:
                controller = controller_for(pose, loop.method, loop.sensing, loop.gains)
            found = hardware_verdict(controller, brief=True)
        except FlexbaseError:
            status[i] = INFEASIBLE
            continue
        if not found.stable:
            status[i] = UNSTABLE
        row = [found.figures[name] for name in MEASURES]
        values[i] = [np.nan if value is None else float(f"{value:.9g}") for value in row]  # beyond are roundings
    return status, values


def _recipe(loop: Method, axes: dict[str, list[float]], held: list[float], block: list[int]) -> dict[str, Any]:
    from importlib.metadata import version

    return {
        "hardware": loop.method if loop.E is None else "given E",
        "robot": loop.plant.name,
        "measures": list(MEASURES),
        "model": model_digest(loop.plant.arm),
        "E": None if loop.E is None else loop.E.tolist(),
        "gains": [loop.gains.stiffness.tolist(), loop.gains.damping.tolist()],
        "sensing": {name: list(v) if isinstance(v, tuple) else v for name, v in asdict(loop.sensing).items()},
        "branch": loop.branch or loop.plant.arm.task.branch,
        "axes": axes,
        "held": held,
        "block": block,
        "versions": {name: version(name) for name in VERSIONED},
    }
