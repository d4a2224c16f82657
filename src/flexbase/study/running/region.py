"""How far from its pose does one constant controller, or one constant E, stay valid? A region around the tip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array, check_left_out, positive_number
from flexbase.errors import InputError, SingularArm, Unreachable
from flexbase.model.loop import Asked, loop_on
from flexbase.model.task import BRANCHES, Gains
from flexbase.plant import Pose, check_pose
from flexbase.requests import Progress, no_progress
from flexbase.sampled.controller import SampledController, pd_with_gain
from flexbase.sampled.judged import judged
from flexbase.sheets.sheet import Sheet, answer, facts, make_sheet
from flexbase.sheets.told import Told
from flexbase.sweeps.cells.axis import block_shape
from flexbase.sweeps.cells.grids import tip_place
from flexbase.sweeps.engine.poses import EachPose, by_processes
from flexbase.sweeps.engine.question import Column
from flexbase.sweeps.engine.runner import run
from flexbase.sweeps.engine.status import OK
from flexbase.sweeps.requests import Cells, Execution
from flexbase.synthesis import HARDWARE_METHODS
from flexbase.synthesis.make import make_controller

OUT_OF_REACH, UNSTABLE, STABLE, SAFE = range(4)
MEANINGS = {
    OUT_OF_REACH: "out of reach",
    UNSTABLE: "unstable",
    STABLE: "stable, no more",
    SAFE: "safe: with margins, and when changed",
}
BLOCK = 25  # cells that a process is given
SAME = 1e-3  # rad or m


@dataclass(frozen=True, eq=False)
class Region(Told):
    """Verdicts on one controller at tips around the pose it was made for.

    what : "E", the gain constant and the task law following the arm, or "controller", everything constant
    rows, units : the two task rows that vary; x, y : their values; grade : shape (y, x), codes of `MEANINGS`
    tip : of the design pose, these two rows
    safe_radius, stable_radius : of the largest disk around the tip within which every reached cell is [m or rad]; None
        where the design pose itself is not
    """

    robot: str
    method: str
    what: str
    rows: tuple[str, str]
    units: tuple[str, str]
    x: Array
    y: Array
    grade: NDArray[np.int8]
    tip: tuple[float, float]
    safe_radius: float | None
    stable_radius: float | None

    meanings: ClassVar = MEANINGS
    document: ClassVar = (
        *("robot", "method", "what", "safe_radius", "stable_radius", "tip", "rows", "x", "y", "grade", "meanings"),
    )

    def sheet(self) -> Sheet:
        """Shares of the reached cells, and how far around the design tip all of them are good."""
        return make_sheet(
            self.robot,
            f"{self.method}, constant {self.what}, around the design tip",
            facts(("safe", self._share(SAFE, self.safe_radius)), ("stable", self._share(STABLE, self.stable_radius))),
            answer(self.safe_radius is not None, "Safe at the design tip", "Not safe at the design tip"),
        )

    def _share(self, code: int, radius: float | None) -> str:
        share = 100.0 * np.mean(self.grade[self.grade > OUT_OF_REACH] >= code)
        near = "not at" if radius is None else f"in all of them within {radius:.3f} {self.units[0]} of"
        return f"in {share:.0f} % of the reached cells, {near} the design tip"


@dataclass(frozen=True, eq=False)
class Grade:
    """How a controller does at a pose; with gains, E alone is kept, and the task PD follows the arm."""

    controller: SampledController
    gains: Gains | None

    def __call__(self, there: Pose) -> tuple[int, Sequence[float]]:
        """Status, and UNSTABLE, STABLE or SAFE."""
        controller = self.controller
        if self.gains is not None:
            controller = pd_with_gain(there, controller.sensing, self.gains, controller.E, controller.name)
        found = judged(controller, there)
        return OK, (UNSTABLE if not found.stable else SAFE if found.accepted() else STABLE,)


def region(
    pose: Pose,
    method: str | SampledController | None = None,
    loop: Asked = None,
    *,
    half_width: float = 0.15,
    shape: Sequence[int] = (25, 25),
    execution: Execution = Execution(),
    progress: Progress = no_progress,
) -> Region:
    """Verdicts in a window around the tip, over the first two task rows; the other rows stay where they are.

    Where the controller is task PD with a gain E, E is what stays constant, and the task law follows the arm; else the
    whole controller does.

    method : whose controller, made at the pose; or one that was made, kept whole; or left out, for task PD with the
        compensator of `loop`, or without any
    half_width : of the window [m or rad]; shape : cells along x and y
    Raises InputError, Infeasible.
    """
    check_pose(pose)
    meant = loop_on(pose.arm, loop)
    if isinstance(method, SampledController):
        controller, kept = method, None
    else:
        controller = make_controller(pose, method, loop)
        kept = meant.gains if method is None or HARDWARE_METHODS[method].law == "gains" else None
    check_left_out(by_processes(execution), ("store", "resume"), "a region is kept in memory. Leave it out.")
    half = positive_number("half_width", half_width, "m or rad")
    rows, units = pose.arm.task.rows, pose.arm.task.units
    if pose.arm.k < 2 or len(shape) != 2 or min(shape) < 2:
        raise InputError(f"shape: {list(shape)} over {pose.arm.k} task rows; two rows and 2 cells or more are needed.")
    branch, tip = _branch(pose), pose.tip
    bounds = tuple(float(tip[i]) + side * half for i in (0, 1) for side in (-1, 1))
    cells = Cells(shape=tuple(shape), bounds=bounds, hold=tuple(tip[2:].tolist()), branch=branch).checked()
    place = tip_place(pose.plant, cells, targets=True)
    grade_of = Grade(controller, kept)
    near = pose.joints
    question = EachPose(pose.plant, (Column("grade", {"units": "1"}),), grade_of, branch, near)
    block = block_shape(place.domain.shape, BLOCK)
    found = run(question, place.domain, block, execution, progress, {})
    grade = np.where(found["status"].values == OK, found["grade"].values, OUT_OF_REACH).astype(np.int8)
    y, x = (axis.values for axis in place.domain.axes)
    distance = np.hypot(x[None, :] - tip[0], y[:, None] - tip[1])
    _, (here,) = grade_of(pose.plant.at_tip(tip, branch, near=near))
    radii = [_radius(distance, grade, code, half) if here >= code else None for code in (SAFE, STABLE)]
    what = "controller" if kept is None else "E"
    return Region(
        pose.plant.name,
        controller.name,
        what,
        (rows[0], rows[1]),
        (units[0], units[1]),
        x,
        y,
        grade,
        (float(tip[0]), float(tip[1])),
        *radii,
    )


def _branch(pose: Pose) -> str:
    """The branch on which inverse kinematics finds the pose again. Raises InputError."""
    for branch in dict.fromkeys((pose.arm.task.branch, *BRANCHES)):
        try:
            again = pose.plant.at_tip(pose.tip, branch, near=pose.joints)
        except (Unreachable, SingularArm, InputError):
            continue
        if np.abs(again.q - pose.q).max() < SAME:
            return branch
    raise InputError(f"{pose.plant.name}: inverse kinematics does not find the pose again. Give it by its tip.")


def _radius(distance: Array, grade: NDArray[np.int8], code: int, half: float) -> float:
    """Distance of the nearest reached cell that is worse than a code; the half-width where there is none."""
    bad = (grade > OUT_OF_REACH) & (grade < code)
    return float(min(distance[bad].min(initial=half), half))
