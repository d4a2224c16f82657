"""How far from its pose does one constant controller, or one constant E, stay valid? A region around the tip."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array, check_length, positive_number
from flexbase.errors import InputError, SingularArm, Unreachable
from flexbase.model.loop import Asked, loop_on
from flexbase.model.task import BRANCHES, Gains
from flexbase.plant import Pose, check_pose
from flexbase.sampled.controller import SampledController, pd_with_gain
from flexbase.sampled.judged import judged
from flexbase.sweeps.engine.pool import in_processes
from flexbase.synthesis import HARDWARE_METHODS, controller_for

OUT_OF_REACH, UNSTABLE, STABLE, SAFE = range(4)
MEANINGS = {
    OUT_OF_REACH: "out of reach",
    UNSTABLE: "unstable",
    STABLE: "stable, no more",
    SAFE: "safe: with margins, and when changed",
}
MOST = 1_000_000
SAME = 1e-3  # rad or m


@dataclass(frozen=True, eq=False)
class Region:
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

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        whole = {name: getattr(self, name) for name in ("robot", "method", "what", "safe_radius", "stable_radius")}
        grid = {"rows": list(self.rows), "x": self.x.tolist(), "y": self.y.tolist(), "grade": self.grade.tolist()}
        return {
            **whole,
            "tip": list(self.tip),
            **grid,
            "meanings": {str(code): said for code, said in MEANINGS.items()},
        }

    def summary(self) -> str:
        """Two lines."""
        reached = self.grade > OUT_OF_REACH
        share = [100.0 * float(np.mean(self.grade[reached] >= code)) for code in (SAFE, STABLE)]
        return (
            f"{self.robot}, {self.method}, constant {self.what}: safe in {share[0]:.0f} %, stable in {share[1]:.0f} % "
            f"of the reached cells\n  safe within {_shown(self.safe_radius, self.units[0])} of the design tip, "
            f"stable within {_shown(self.stable_radius, self.units[0])}"
        )


class _Cell(NamedTuple):
    controller: SampledController
    gains: Gains | None  # where E alone is constant
    target: tuple[float, ...]
    branch: str


def validity(
    controller: SampledController,
    gains: Gains | None = None,
    *,
    half_width: float = 0.15,
    shape: Sequence[int] = (25, 25),
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Region:
    """Verdicts in a window around the tip, over the first two task rows; the other rows stay where they are.

    With `gains`, E is what stays constant, and the task PD with these gains follows the arm; without, the whole
    controller does. half_width : of the window [m or rad]. Raises InputError.
    """
    pose = controller.pose
    half = positive_number("half_width", half_width, "m or rad")
    counts = check_length("shape", shape, 2, "cells along x and y").astype(int)
    if pose.arm.k < 2 or counts.min() < 2 or counts.prod() > MOST:
        raise InputError(
            f"shape: {list(shape)} over {pose.arm.k} task rows; two rows and 2 to {MOST} cells are needed."
        )
    x, y = (pose.tip[i] + np.linspace(-half, half, int(counts[i])) for i in (0, 1))
    branch = _branch(pose)
    targets = [(float(a), float(b), *pose.tip[2:].tolist()) for b in y for a in x]
    cells = [_Cell(controller, gains, target, branch) for target in targets]
    found = np.zeros(len(cells), dtype=np.int8)
    for done, (number, code) in enumerate(in_processes(_grade, cells, workers), start=1):
        found[number] = code
        progress(done, len(cells))
    grade = found.reshape(len(y), len(x))
    distance = np.hypot(x[None, :] - pose.tip[0], y[:, None] - pose.tip[1])
    here = _grade(_Cell(controller, gains, tuple(pose.tip.tolist()), branch))
    radii = [_radius(distance, grade, code, half) if here >= code else None for code in (SAFE, STABLE)]
    rows, units = pose.arm.task.rows, pose.arm.task.units
    what = "controller" if gains is None else "E"
    tip = float(pose.tip[0]), float(pose.tip[1])
    return Region(
        pose.plant.name, controller.name, what, (rows[0], rows[1]), (units[0], units[1]), x, y, grade, tip, *radii
    )


def _grade(cell: _Cell) -> int:
    pose = cell.controller.pose
    try:
        there = pose.plant.at_tip(cell.target, cell.branch, near=pose.joints)
    except (Unreachable, SingularArm):
        return OUT_OF_REACH
    controller = cell.controller
    if cell.gains is not None:
        controller = pd_with_gain(there, controller.sensing, cell.gains, controller.E, controller.name)
    found = judged(controller, there)
    if not found.stable:
        return UNSTABLE
    return SAFE if found.accepted() else STABLE


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


def _shown(radius: float | None, unit: str) -> str:
    return "none" if radius is None else f"{radius:.3f} {unit}"


def region(
    pose: Pose,
    method: str,
    loop: Asked = None,
    half_width: float = 0.15,
    progress: Callable[[int, int], None] = lambda done, total: None,
    shape: Sequence[int] = (25, 25),
) -> Region:
    """`validity` of a method's controller at a pose: of its E where it is task PD with E, else of the whole controller.

    Raises InputError, Infeasible.
    """
    check_pose(pose)
    meant = loop_on(pose.arm, loop)
    controller = controller_for(pose, method, meant.sensing, meant.gains)
    follows = HARDWARE_METHODS[method].law == "gains"
    kept = meant.gains if follows else None
    return validity(controller, kept, half_width=half_width, shape=shape, progress=progress)
