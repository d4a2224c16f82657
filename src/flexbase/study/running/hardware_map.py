"""Verdicts on the loop as it runs over a plane of tips: a question that is asked pose by pose."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from flexbase.cautions import collected
from flexbase.checks import Array, check_left_out, choose
from flexbase.errors import FlexbaseError, InputError
from flexbase.model.loop import Asked, LoopSpec, loop_on
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Plant, Pose, check_plant
from flexbase.requests import Progress, no_progress
from flexbase.sampled.controller import pd_with_gain
from flexbase.sampled.figures import FIGURES
from flexbase.sampled.judged import judged
from flexbase.sweeps.cells.axis import block_shape
from flexbase.sweeps.cells.grids import tip_place
from flexbase.sweeps.engine.poses import EachPose, by_processes
from flexbase.sweeps.engine.question import MEASURED, Column
from flexbase.sweeps.engine.runner import run
from flexbase.sweeps.engine.status import INFEASIBLE, OK, UNSTABLE
from flexbase.sweeps.kept.recipe import recipe_of
from flexbase.sweeps.requests import TIP, Cells, Execution
from flexbase.synthesis import HARDWARE_METHODS, controller_for

if TYPE_CHECKING:
    import xarray

MEASURES = {name: (one.unit, one.purpose) for name, one in FIGURES.items() if one.brief}
BLOCK = 50  # cells: what a process is given, and what an interruption costs at most
USUAL_SHAPE = (50, 50)


@dataclass(frozen=True, eq=False)
class Judge:
    """The brief verdict on the controller of a pose: a method's own, or task PD with one E."""

    method: str
    sensing: Sensing
    gains: Gains
    E: Array | None

    def __call__(self, pose: Pose) -> tuple[int, Sequence[float]]:
        """Status and figures, NaN where a figure has no meaning."""
        try:
            if self.E is not None:
                controller = pd_with_gain(pose, self.sensing, self.gains, self.E, "given")
            else:
                controller = controller_for(pose, self.method, self.sensing, self.gains)
            found = judged(controller)
            figures = [found.figure(name) for name in MEASURES]
        except FlexbaseError:
            return INFEASIBLE, ()
        digits = [np.nan if value is None else float(f"{value:.9g}") for value in figures]  # beyond are roundings
        return OK if found.stable else UNSTABLE, digits

    @property
    def recipe(self) -> dict[str, Any]:
        """What it depends on beside the pose, as plain JSON values."""
        return {
            "hardware": self.method if self.E is None else "given E",
            "compensator": None if self.E is None else self.E.tolist(),
            "gains": [self.gains.stiffness.tolist(), self.gains.damping.tolist()],
            "sensing": {name: list(v) if isinstance(v, tuple) else v for name, v in asdict(self.sensing).items()},
        }


def hardware_map(
    plant: Plant,
    method: str = "none",
    cells: Cells = Cells(),
    *,
    loop: Asked = None,
    execution: Execution = Execution(),
    progress: Progress = no_progress,
) -> xarray.Dataset:
    """Verdicts over tips, an `xarray.Dataset` like that of a sweep; `MEASURES` says what is in it.

    Each cell is its own pose, with a controller made for it: by the method, or task PD with a given compensator's E.
    The verdict is the brief one: without delay and lag margins. Unstable cells have that status, and the values of
    those measures that are defined there.

    cells : over tip, 50 x 50 if no shape is given; execution : in processes, one a core if left out
    Raises InputError.
    """
    cells, execution = _over_tips(cells).shaped(USUAL_SHAPE), by_processes(execution)
    with collected() as said:
        question, meant = question_of(plant, method, loop, cells.branch)
    place = tip_place(plant, cells, targets=True)
    block = block_shape(place.domain.shape, BLOCK)
    recipe = recipe_of(question, plant.arm, place, cells.branch or plant.arm.task.branch, block)
    attributes = {
        "robot": plant.name,
        "compensated": int(meant.E is not None),
        "judged": judged_by(method, meant),
        "over": TIP,
        "cautions": "\n".join(said),
    }
    return run(question, place.domain, block, execution, progress, attributes, recipe)


def judged_by(method: str, meant: LoopSpec) -> str:
    """What is judged, in words."""
    return f"{'given E' if meant.E is not None else f'method {method}'} at {meant.sensing.rate:g} Hz"


def question_of(plant: Plant, method: str, loop: Asked, branch: str | None) -> tuple[EachPose, LoopSpec]:
    """What is asked in every cell, checked, and the loop that is meant. Raises InputError."""
    choose("method", method, HARDWARE_METHODS)
    check_plant(plant)
    meant = loop_on(plant.arm, loop)
    ask = Judge(method, meant.sensing, meant.gains, meant.E)
    columns = [
        Column(name, {"units": unit, "long_name": purpose, MEASURED: "1"}) for name, (unit, purpose) in MEASURES.items()
    ]
    return EachPose(plant, tuple(columns), ask, branch, recipe=ask.recipe), meant


def _over_tips(cells: Cells) -> Cells:
    """The cells, checked for what a map of verdicts cannot vary."""
    if Cells.checked(cells).over != TIP:
        raise InputError(f"over: verdicts are mapped over tip, not over {cells.over}. Leave it out.")
    check_left_out(cells, ("vary",), "verdicts are on the plant as it is. Leave it out.")
    return cells
