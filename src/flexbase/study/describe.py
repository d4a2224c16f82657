"""What a project says, and what holds at a pose: the answer to `flexbase check`."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from flexbase.checks import Array
from flexbase.plant import Plant, Pose


@dataclass(frozen=True, eq=False)
class Description:
    """A plant in words and numbers, and one pose of it where one was asked for. Made by `describe`."""

    plant: Plant
    pose: Pose | None = None

    @property
    def joints(self) -> tuple[dict[str, str], ...]:
        """Every joint in chain order: name, type, unit, and the part it belongs to, "base" or "arm"."""
        arm, chain = self.plant.arm, self.plant.arm.mechanism
        return tuple(
            {
                "name": name,
                "type": kind,
                "unit": unit,
                "part": "base" if i in arm.parts.passive else "arm",
            }
            for i, (name, kind, unit) in enumerate(
                zip(chain.joint_names, chain.joint_types, chain.joint_units, strict=True)
            )
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

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI units; "pose", "gains", "sensing" are None where there are none."""
        arm = self.plant.arm
        gains = arm.gains
        return {
            "name": self.plant.name,
            "m": arm.m,
            "n": arm.n,
            "k": arm.k,
            "joints": list(self.joints),
            "task": {"rows": list(arm.task.rows), "units": list(arm.task.units), "branch": arm.task.branch},
            "base": {
                "stiffness": arm.base.stiffness.tolist(),
                "damping": arm.base.damping.tolist(),
                "equilibrium": arm.base.equilibrium.tolist(),
            },
            "gravity": arm.gravity.tolist(),
            "gains": gains and {"stiffness": gains.stiffness.tolist(), "damping": gains.damping.tolist()},
            "sensing": arm.sensing and asdict(arm.sensing),
            "pose": self._pose_to_dict(),
        }

    def _pose_to_dict(self) -> dict[str, Any] | None:
        pose, sag = self.pose, self.sag
        if pose is None or sag is None:
            return None
        return {
            "q": pose.q.tolist(),
            "tip": pose.tip.tolist(),
            "condition_number_M": self.condition_number,
            "sag": sag.tolist(),
            "holding_torque": pose.holding_torque.tolist(),
        }

    def summary(self) -> str:
        """A few lines in plain text."""
        facts = self.to_dict()
        joints = ", ".join(f"{joint['name']} ({joint['part']}, {joint['type']})" for joint in self.joints)
        lines = [
            f"{facts['name']}: m = {facts['m']} base joints, n = {facts['n']} arm joints, k = {facts['k']} task rows",
            f"  joints: {joints}",
            f"  task: {' '.join(facts['task']['rows'])}, branch {facts['task']['branch']}",
            *(f"  base {name}: {value}" for name, value in facts["base"].items()),
            f"  gravity: {facts['gravity']} m/s^2",
            f"  gains: {facts['gains'] or 'none'}",
            f"  sensing: {self.plant.arm.sensing.summary() if self.plant.arm.sensing else 'not declared'}",
        ]
        return "\n".join([*lines, *(f"  {name}: {value}" for name, value in (facts["pose"] or {}).items())])


def describe(plant: Plant, pose: Pose | None = None) -> Description:
    """What a project says, and at a pose: tip, condition of M, sag of the base, torque that holds against gravity."""
    return Description(plant, pose)
