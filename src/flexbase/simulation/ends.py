"""Where a run starts and ends: poses of its plant, or tip targets that name one."""

from __future__ import annotations

from numpy.typing import ArrayLike

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.plant import Plant, Pose


def end_on(plant: Plant, wanted: Pose | ArrayLike, near: Array | None) -> Pose:
    """The pose, or of a tip target's several postures the nearest to n arm joints. Raises InputError, Unreachable."""
    if not isinstance(wanted, Pose):
        return plant.at_tip(wanted, near=near)
    if wanted.plant.name != plant.name:
        raise InputError(
            f"simulate: a pose of {wanted.plant.name} is no pose of {plant.name}. "
            "Make it with this plant's at or at_tip."
        )
    check_same_joints(plant, wanted)
    return wanted


def check_same_joints(plant: Plant, pose: Pose) -> None:
    """Raises InputError for a pose of a robot with other joints."""
    here, there = plant.arm.mechanism, pose.arm.mechanism
    if (here.joint_names, here.joint_types, plant.arm.parts) != (there.joint_names, there.joint_types, pose.arm.parts):
        raise InputError(
            f"simulate: {pose.plant.name} has other joints than {plant.name}. Give a pose of the same robot, or of one "
            "that differs in numbers only."
        )
