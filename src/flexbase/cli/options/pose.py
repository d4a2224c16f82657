"""The robot, the pose and the compensator that a command line names."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Group, Parameter

from flexbase.cli.options.common import blaming, option
from flexbase.cli.options.values import Vector, numbers, sign
from flexbase.control.compensator import Compensator, load_compensator
from flexbase.errors import InputError
from flexbase.model.loop import loop_on
from flexbase.plant import Plant, Pose

Robot = Annotated[str, Parameter(help="bundled name (see: flexbase robots) or path of a project file")]
SIDES = ("--elbow", "--branch")
Elbow = Annotated[str | None, option(sign, "+|-", "elbow; or shoulder, elbow, wrist: +-+; else the project's", SIDES)]
AnyElbow = Annotated[str | None, option(sign, "+|-", "elbow; or shoulder, elbow, wrist: +-+; else the best", SIDES)]
POSE = Group("Pose", sort_key=10)


@Parameter(name="*", group=POSE)
@dataclass(frozen=True)
class PoseOptions:
    """Where the arm stands."""

    tip: Annotated[Vector | None, option(numbers, "X,Y", "where the tip rests, one number a task row [m, rad]")] = None
    elbow: Elbow = None
    joints: Annotated[
        Vector | None, option(numbers, "Q,Q", "arm joints, or all joints, base first (then its equilibrium) [rad, m]")
    ] = None

    def pose(self, plant: Plant) -> Pose:
        """The one pose that the options name. Raises InputError."""
        found = self.pose_or_none(plant)
        if found is None:
            raise InputError("--tip or --joints is missing. Say where the arm stands, such as --tip 0.33,-0.25.")
        return found

    def pose_or_none(self, plant: Plant) -> Pose | None:
        """The pose that the options name, or None where they name none. Raises InputError."""
        if self.tip is not None and self.joints is not None:
            raise InputError("--tip and --joints are both given. Give one of them.")
        if self.elbow is not None and self.tip is None:
            raise InputError(
                f"--elbow: {self.elbow} chooses among the poses of a --tip, and there is none. Leave it out."
            )
        if self.tip is not None:
            return tip_pose(plant, "--tip", self.tip, self.elbow)
        return None if self.joints is None else plant.at(self.joints)


def tip_pose(plant: Plant, option: str, tip: Vector, elbow: str | None, near: Pose | Compensator | None = None) -> Pose:
    """The pose at a tip target, of several the nearest to `near`; a fault names the option. Raises InputError."""
    with blaming(option):
        return plant.at_tip(tip, elbow, plant.arm.parts.arm(near.q) if near and len(near.q) == plant.arm.N else None)


def compensator_of(plant: Plant, path: Path | None) -> Compensator | None:
    """The compensator in a file, or None. Raises InputError."""
    if path is None:
        return None
    with blaming("--compensator"):
        found = load_compensator(path)
        loop_on(plant.arm, found)
    return found
