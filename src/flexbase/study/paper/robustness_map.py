"""Fig. 6 and 8: w_1 over all that the tip can reach, and where it touches zero."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.inverse.arm_angles import arm_angles_of_many
from flexbase.dynamics.inverse.two_joint_arm import two_joint_arm
from flexbase.dynamics.kinematics import forward
from flexbase.errors import InputError
from flexbase.measures import MEASURES
from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Plant
from flexbase.sweeps.engine.evaluate import Engine
from flexbase.sweeps.engine.formula import Formula
from flexbase.trace.algebra import stack, unstack

RINGS, SPOKES = 126, 361
RIM = 1e-6  # of the reach, kept clear of its edges, where the arm is singular


@dataclass(frozen=True, eq=False)
class RobustnessMap:
    """w_1 on rings about the shoulder, between the two circles where the arm is singular.

    x, y : tip positions, shape (rings, spokes) [m]; the last spoke closes the circle
    robustness : w_1 [m/(N s^2)], NaN unless the status is OK; turn : angle from b to a [rad]
    smallest_inertia : smallest eigenvalue of M - E; below zero the arm under this E has no meaning
    status : a key of `flexbase.sweeps.STATUS`
    shoulder, inner, outer : centre [m] and radii [m] of the reachable ring
    """

    x: Array
    y: Array
    robustness: Array
    turn: Array
    smallest_inertia: Array
    status: NDArray[np.int8]
    shoulder: tuple[float, float]
    inner: float
    outer: float
    compensated: bool

    @property
    def indefinite(self) -> bool:
        """Whether M - E loses definiteness somewhere."""
        return bool((self.smallest_inertia <= 0.0).any())


def robustness_map(plant: Plant, loop: Asked = None, shape: tuple[int, int] = (RINGS, SPOKES)) -> RobustnessMap:
    """w_1 over the workspace of a planar arm with two joints on a one-joint base, default branch, base at rest.

    Raises InputError for other arms.
    """
    arm = plant.arm
    planar = two_joint_arm(arm.mechanism, arm.task, arm.base.equilibrium)
    if planar is None or arm.m != 1:
        raise InputError(
            f"{plant.name}: this map needs two parallel arm joints in the task's plane and one base joint."
        )
    inner, outer = abs(planar.upper - planar.fore), planar.upper + planar.fore
    dense_at_rims = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, shape[0]))[:, None]  # where w changes fastest
    radii = inner + RIM * outer + (outer - inner - 2.0 * RIM * outer) * dense_at_rims
    angles = np.linspace(-np.pi, np.pi, shape[1])[None, :]
    x, y = planar.shoulder[0] + radii * np.cos(angles), planar.shoulder[1] + radii * np.sin(angles)
    targets = np.column_stack([x.ravel(), y.ravel()])
    joints, _ = arm_angles_of_many(arm.mechanism, arm.task, arm.base.equilibrium, targets, arm.task.branch)
    E = loop_on(plant.arm, loop).E
    asked = (MEASURES["robustness"], MEASURES["turn"])
    block = Engine(Formula(arm, asked, (0, 1), (0.0, 0.0), E=E)).run(np.ascontiguousarray(joints.T))
    frames = forward(arm.mechanism, arm.parts.whole(arm.base.equilibrium.tolist(), unstack(joints, 1)))
    inertia = stack(mass_matrix(frames))
    if E is not None:
        inertia = inertia - arm.parts.on_arm(E)
    return RobustnessMap(
        x,
        y,
        block.values["robustness"].reshape(x.shape),
        block.values["turn"].reshape(x.shape),
        np.linalg.eigvalsh(inertia)[:, 0].reshape(x.shape),
        block.status.reshape(x.shape),
        (float(planar.shoulder[0]), float(planar.shoulder[1])),
        inner,
        outer,
        E is not None,
    )
