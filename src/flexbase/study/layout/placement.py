"""Where a set of tip targets is put: moved along some axes, and turned about the vertical."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from flexbase.checks import Array
from flexbase.errors import InputError, nearest_name
from flexbase.model.task import Task


@dataclass(frozen=True, eq=False)
class Placement:
    """A rigid motion of all targets with a few variables: first the shifts [m], then the turn [rad], if any.

    Assumes a task with all three rotation rows, with rz alone, or without any, where there is a turn. Where rotation
    rows are left open the rows' components of the rotation vector are moved as they are.

    along : task rows, among x y z, along which the targets may move
    turns : whether they may turn about the vertical through `centre`, shape (2,) [m]
    reach : largest shift [m], and `swing` the largest turn [rad]
    """

    task: Task
    along: tuple[str, ...] = ()
    turns: bool = False
    centre: tuple[float, float] = (0.0, 0.0)
    reach: float = 0.0
    swing: float = np.pi

    @property
    def size(self) -> int:
        """How many variables."""
        return len(self.along) + self.turns

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """Low and high of each variable."""
        return [(-self.reach, self.reach)] * len(self.along) + [(-self.swing, self.swing)] * self.turns

    def clipped(self, shift: Array) -> Array:
        """The variables within their bounds, which rounding may leave."""
        if not self.size:
            return shift
        low, high = np.array(self.bounds).T
        return np.asarray(np.clip(shift, low, high))

    def moved(self, targets: Array, shift: Array) -> Array:
        """Targets (T, k) in their new places."""
        moved = np.array(targets, dtype=float)
        rows = self.task.rows
        if self.turns:
            angle = shift[-1]
            c, s = np.cos(angle), np.sin(angle)
            x, y = (targets[:, rows.index(row)] - mid for row, mid in zip("xy", self.centre, strict=True))
            moved[:, rows.index("x")] = self.centre[0] + c * x - s * y
            moved[:, rows.index("y")] = self.centre[1] + s * x + c * y
            moved[:, self._rotations()] = self._turned(targets[:, self._rotations()], angle)
        for row, value in zip(self.along, shift, strict=False):
            moved[:, rows.index(row)] += value
        return moved

    def slope(self, targets: Array, shift: Array) -> Array:
        """Rate of the tip that follows the targets, by each variable, shape (T, k, size); rotations: angular rates."""
        slope = np.zeros((*targets.shape, self.size))
        rows = self.task.rows
        for i, row in enumerate(self.along):
            slope[:, rows.index(row), i] = 1.0
        if self.turns:
            still = np.array([*np.zeros(len(self.along)), shift[-1]])
            turned = self.moved(targets, still)
            slope[:, rows.index("x"), -1] = -(turned[:, rows.index("y")] - self.centre[1])
            slope[:, rows.index("y"), -1] = turned[:, rows.index("x")] - self.centre[0]
            if "rz" in rows:
                slope[:, rows.index("rz"), -1] = 1.0
        return slope

    def _rotations(self) -> list[int]:
        return [i for i, row in enumerate(self.task.rows) if row.startswith("r")]

    def _turned(self, values: Array, angle: float) -> Array:
        """Rotation coordinates turned about the vertical: rotation vectors, or the one angle rz."""
        if values.shape[1] < 3:
            return values + angle
        return np.asarray((Rotation.from_rotvec([0.0, 0.0, angle]) * Rotation.from_rotvec(values)).as_rotvec())


def make_placement(task: Task, values: Array, along: Sequence[str] | None, turn: bool, largest: float) -> Placement:
    """How targets (T, k) may move; along all positions if `along` is None, each by at most `largest` [m].

    Raises InputError.
    """
    rows = [row for row in task.rows if row in "xyz"]
    for row in along or ():
        if row not in rows:
            raise InputError(f'along: no position "{row}" in the task. {nearest_name(row, rows)}')
    chosen = tuple(rows) if along is None else tuple(dict.fromkeys(along))
    turned = [row for row in task.rows if row.startswith("r")]
    if turn and not ({"x", "y"} <= set(rows) and (len(turned) in (0, 3) or turned == ["rz"])):
        raise InputError(
            f"turn: a task of {' '.join(task.rows)} cannot follow the work about the vertical: x and y are needed, and "
            "all rotation rows, rz alone, or none. Leave it out."
        )
    if not chosen and not turn:
        raise InputError("along: the work may neither move nor turn. Name an axis.")
    centre = (0.0, 0.0)
    if turn:
        middle = [0.5 * (values[:, i].min() + values[:, i].max()) for i in (task.rows.index("x"), task.rows.index("y"))]
        centre = (float(middle[0]), float(middle[1]))
    return Placement(task, chosen, turn, centre, largest)
