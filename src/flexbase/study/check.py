"""What a project says, and what holds at a pose: the answer to `flexbase check`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flexbase.checks import Array
from flexbase.plant import Plant, Pose
from flexbase.sheets import units
from flexbase.sheets.numbers import listed, matrix, number
from flexbase.sheets.sheet import Column, Sheet, Table, facts, make_sheet, table, words
from flexbase.sheets.told import Told


@dataclass(frozen=True, eq=False)
class Check(Told):
    """A plant in words and numbers, and one pose of it where one was asked for. Made by `check`."""

    plant: Plant
    pose: Pose | None = None

    document: ClassVar = (
        "name=plant.name",
        "m=plant.arm.m",
        "n=plant.arm.n",
        "k=plant.arm.k",
        "joints",
        "task=_task",
        "base=plant.arm.base",
        "gravity=plant.arm.gravity",
        "gains=plant.arm.gains",
        "sensing=plant.arm.sensing",
        "pose=_at_pose",
    )

    @property
    def joints(self) -> tuple[dict[str, str], ...]:
        """Every joint in chain order: name, type, unit, and the part it belongs to, "base" or "arm"."""
        arm, chain = self.plant.arm, self.plant.arm.mechanism
        rows = zip(chain.joint_names, chain.joint_types, chain.joint_units, strict=True)
        return tuple(
            {"name": name, "type": kind, "unit": unit, "part": "base" if i in arm.parts.passive else "arm"}
            for i, (name, kind, unit) in enumerate(rows)
        )

    @property
    def condition_number(self) -> float | None:
        """Largest over smallest eigenvalue of M at the pose; None without a pose."""
        if self.pose is None:
            return None
        eigenvalues = np.linalg.eigvalsh(self.pose.M)
        return float(eigenvalues[-1] / eigenvalues[0])

    @property
    def sag(self) -> Array | None:
        """How far gravity brings the base joints from their equilibrium, shape (m,); None without a pose."""
        return None if self.pose is None else self.pose.sag

    @property
    def _task(self) -> dict[str, Any]:
        task = self.plant.arm.task
        return {"rows": task.rows, "units": task.units, "branch": task.branch}

    @property
    def _at_pose(self) -> dict[str, Any] | None:
        pose = self.pose
        if pose is None:
            return None
        found = {"q": pose.q, "tip": pose.tip, "condition_number_M": self.condition_number, "sag": pose.sag}
        return {**found, "holding_torque": pose.holding_torque}

    def sheet(self) -> Sheet:
        """The joints, and what the project says; with a pose, also what holds there."""
        arm, gains, task, sag = self.plant.arm, self.plant.arm.gains, self.plant.arm.task, self.sag
        names, kinds = arm.parts.base(arm.mechanism.joint_names), arm.parts.base(arm.mechanism.joint_units)
        said = [("task rows", f"{' '.join(task.rows)}, elbow {task.branch}")]
        if arm.m:
            said += [
                (f"base stiffness [{units.common('stiffness', kinds)}]", matrix(arm.base.stiffness)),
                (f"base damping [{units.common('damping', kinds)}]", matrix(arm.base.damping)),
                ("base equilibrium", listed(arm.base.equilibrium, names, kinds)),
            ]
        if gains is not None:
            said += [
                (f"task stiffness [{units.common('stiffness', task.units)}]", matrix(gains.stiffness)),
                (f"task damping [{units.common('damping', task.units)}]", matrix(gains.damping)),
            ]
        if arm.sensing is not None:
            said += [("sensing", arm.sensing.summary())]
        said += [("gravity", f"{listed(arm.gravity, 'xyz')} m/s^2" if arm.has_gravity else "none")]
        if self.pose is not None and sag is not None:
            said += [
                ("tip", listed(self.pose.tip, task.rows, task.units)),
                ("condition number of M", number(self.condition_number, 6)),
                ("base sag", listed(sag, names, kinds) or "none: rigid base"),
            ]
        counts = f"{arm.m} base and {arm.n} arm joints, {arm.k} task rows"
        return make_sheet(self.plant.name, counts, self._joints(), facts(*said))

    def _joints(self) -> Table:
        """A row a joint; with a pose, also where it stands and what holds it."""
        arm, heads = self.plant.arm, [words("joint"), words("part"), words("type")]
        rows = [[joint["name"], joint["part"], joint["type"]] for joint in self.joints]
        if self.pose is None:
            return table(heads, rows)
        held = zip(self.pose.holding_torque, units.each("effort", arm.joint_units), strict=True)
        torques = dict(zip(arm.joint_names, (f"{number(torque)} {unit}" for torque, unit in held), strict=True))
        stands = (f"{number(q)} {unit}" for q, unit in zip(self.pose.q, arm.mechanism.joint_units, strict=True))
        both = zip(rows, stands, strict=True)
        heads += [Column("position"), Column("holding torque")]
        return table(heads, ([*row, q, torques.get(row[0], "")] for row, q in both))


def check(plant: Plant, pose: Pose | None = None) -> Check:
    """What a project says, and at a pose: tip, condition of M, sag of the base, torque that holds against gravity."""
    return Check(plant, pose)
