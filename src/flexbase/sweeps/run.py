"""Sweep a plant: measures over joints, tip positions, parameters or samples, in blocks, resumable."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from flexbase.cautions import collected
from flexbase.checks import choose
from flexbase.errors import InputError
from flexbase.measures import MEASURES, Measure
from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Plant, check_plant
from flexbase.requests import Progress, no_progress
from flexbase.sweeps.caveats import check_measures
from flexbase.sweeps.cells.axis import block_shape
from flexbase.sweeps.cells.domain import Grid
from flexbase.sweeps.cells.grids import place_of
from flexbase.sweeps.engine.evaluate import COMPILED, chosen_engine
from flexbase.sweeps.engine.formula import Formula
from flexbase.sweeps.engine.runner import run
from flexbase.sweeps.engine.traced import Traced
from flexbase.sweeps.kept.recipe import recipe_of
from flexbase.sweeps.requests import Cells, Execution

if TYPE_CHECKING:
    import xarray

QUICK_BLOCK, SLOW_BLOCK = 1 << 20, 1 << 14  # cells a block: compiled, or with steps in NumPy


def sweep(
    plant: Plant,
    measures: Sequence[str] = ("robustness",),
    cells: Cells = Cells(),
    *,
    loop: Asked = None,
    execution: Execution = Execution(),
    progress: Progress = no_progress,
) -> xarray.Dataset:
    """Measures over many configurations, the base at its equilibrium; an `xarray.Dataset`.

    Modes are those of `real_modes`: exact for one base joint and for proportional damping. Gravity's sag and stiffness
    and joint friction are left out.

    cells : which configurations; execution : how they are worked through
    Raises InputError, MissingExtra. A cell that cannot be judged gets a status instead of values.
    """
    check_plant(plant)
    cells, execution = Cells.checked(cells), Execution.checked(execution)
    if not isinstance(measures, Iterable):
        raise InputError(
            f"measures: {type(measures).__name__} given. Give names of measures; cells by name, such as cells=Cells()."
        )
    names = [measures] if isinstance(measures, str) else list(measures)
    chosen = tuple(choose("measure", name, MEASURES) for name in dict.fromkeys(names))
    with collected() as said:
        check_measures(plant, chosen, "map")
        place, E = place_of(plant, cells), loop_on(plant.arm, loop).E
        if execution.store is None:
            chosen += _companions(plant, chosen)
        formula = Formula(
            plant.arm, chosen, place.varied, place.held, tuple(cells.vary or {}), E, place.planar, place.side
        )
        shape = place.domain.shape
        engine = chosen_engine(execution.engine, formula, int(np.prod(shape, dtype=np.int64)))
    solves = isinstance(place.domain, Grid) and place.domain.solve is not None
    quick = engine == COMPILED and not solves and not any(one.slow for one in chosen)
    block = block_shape(shape, QUICK_BLOCK if quick else SLOW_BLOCK)
    question = Traced(formula, engine, tuple(names))
    recipe = recipe_of(question, plant.arm, place, cells.branch or plant.arm.task.branch, block)
    attributes = {
        "robot": plant.name,
        "compensated": int(E is not None),
        "over": cells.over,
        "cautions": "\n".join(said),
    }
    return run(question, place.domain, block, execution, progress, attributes, recipe)


def _companions(plant: Plant, chosen: Sequence[Measure]) -> tuple[Measure, ...]:
    """Measures that change their sign where one of the chosen only touches zero: pictures draw it by them."""
    arm = plant.arm
    lines = [MEASURES[one.zero_line] for one in chosen if one.zero_line]
    return tuple(line for line in lines if line not in chosen and not line.needs(arm.m, arm.n, arm.k))
