"""The plant as a sampled controller meets it: torques held and late, sensors late, everything else exact."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexbase.linear.discrete.system import Discrete, delay, hold, series, side_by_side, static
from flexbase.linear.second_order import StateSpace
from flexbase.model.sensing import Sensing
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
    joints = pose.q[arm.m :].copy()
    for joint, offset in change.joints:
        joints[joint] += offset
    return Plant(replace(arm, base=base, mechanism=mechanism)).at(np.concatenate([pose.equilibrium, joints]))


def sampled_plant(pose: Pose, sensing: Sensing) -> Discrete:
    """From torque commands (n) and forces at the tip (k) to what is measured, exact for torques held over a sample.

    Outputs: tip error (k), joints (n), accelerations (n); after these the true tip displacement (k), not late. Tip
    forces act on base and arm alike, held too.
    """
    N, n, k, m = pose.arm.N, pose.arm.n, pose.arm.k, pose.arm.m
    inverse = np.linalg.inv(pose.M)
    push = np.hstack([np.eye(N)[:, m:], pose.J.T])
    A = np.block([[np.zeros((N, N)), np.eye(N)], [-inverse @ pose.K, -inverse @ pose.D]])
    B = np.vstack([np.zeros((N, n + k)), inverse @ push])
    joints = np.eye(N)[m:]
    still = np.zeros((n, N))
    if sensing.acceleration == "accelerometer" and sensing.accelerometer_lag > 0.0:
        T = sensing.accelerometer_lag
        A = np.block([[A, np.zeros((2 * N, n))], [A[N + m :] / T, -np.eye(n) / T]])
        B = np.vstack([B, B[N + m :] / T])
        seen, direct = np.hstack([still, still, np.eye(n)]), np.zeros((n, n + k))
    else:
        seen, direct = A[N + m :], B[N + m :]
    extra = A.shape[0] - 2 * N
    position = np.hstack([np.vstack([pose.J, joints]), np.zeros((k + n, N + extra))])
    C = np.vstack([position, seen, position[:k]])
    D = np.vstack([np.zeros((k + n, n + k)), direct, np.zeros((k, n + k))])
    held = hold(StateSpace(A, B, C, D), sensing.step)
    late_torque = side_by_side(delay(n, sensing.compute_delay, sensing.step), static(np.eye(k), sensing.step))
    late_tip = side_by_side(delay(k, sensing.task_delay, sensing.step), static(np.eye(2 * n + k), sensing.step))
    return series(series(late_torque, held), late_tip)
