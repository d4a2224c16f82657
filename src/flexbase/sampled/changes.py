"""Robots that differ from the model that a controller was made from: those that every verdict tries.  [theory §10]"""

from __future__ import annotations

from dataclasses import dataclass, replace

from flexbase.plant import Plant, Pose


@dataclass(frozen=True)
class Changed:
    """One way in which a robot differs from the model that its controller was made from.

    base_stiffness : factor; last_link : factor on mass and inertia of the last link; joints : arm joint -> offset
    [rad or m]
    """

    label: str
    base_stiffness: float = 1.0
    last_link: float = 1.0
    joints: tuple[tuple[int, float], ...] = ()


def eight_changes(n: int) -> tuple[Changed, ...]:
    """Base stiffness +-20 %, last link +-10 %, each joint +-0.1: eight for two arm joints.  [theory §10]"""
    changes = [Changed(f"base stiffness {sign}20 %", base_stiffness=1.0 + float(f"{sign}0.2")) for sign in "+-"]
    changes += [Changed(f"last link {sign}10 %", last_link=1.0 + float(f"{sign}0.1")) for sign in "+-"]
    for joint in range(n):
        changes += [Changed(f"joint {joint + 1} {sign}0.1", joints=((joint, float(f"{sign}0.1")),)) for sign in "+-"]
    return tuple(changes)


def changed_pose(pose: Pose, change: Changed) -> Pose:
    """The pose of the robot that is really there."""
    arm = pose.arm
    base = replace(arm.base, stiffness=change.base_stiffness * arm.base.stiffness)
    mechanism = arm.mechanism
    if change.last_link != 1.0:
        mass, inertia = mechanism.mass.copy(), mechanism.inertia.copy()
        mass[-1], inertia[-1] = change.last_link * mass[-1], change.last_link * inertia[-1]
        mechanism = replace(mechanism, mass=mass, inertia=inertia)
    joints = pose.joints.copy()
    for joint, offset in change.joints:
        joints[joint] += offset
    return Plant(replace(arm, base=base, mechanism=mechanism)).at(arm.parts.whole(pose.equilibrium, joints))
