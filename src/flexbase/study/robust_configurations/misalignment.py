"""The condition for a robust arm configuration as equations in the arm joints, with their exact derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.kinematics import forward
from flexbase.dynamics.task import task_value
from flexbase.errors import InputError
from flexbase.linear.reduced import misalignment
from flexbase.measures import MEASURES
from flexbase.model.digest import model_digest
from flexbase.model.loop import Asked, loop_on
from flexbase.model.mounted import MountedArm
from flexbase.plant import Plant, check_plant
from flexbase.sweeps.caveats import check_measures
from flexbase.sweeps.cells.parameters import configuration_of
from flexbase.trace.algebra import Scalar, Vector, mul, norm, or_one, sub, unstack
from flexbase.trace.kernel import Kernel, kernel_of

TITLE = "robust arm configurations"


@dataclass(frozen=True, eq=False)
class Misalignment:
    """How far the output shape a of each mode is from its input shape b.  [theory §4]

    d = a/|a| - b/|b| vanishes exactly where the mode is positive real; half its square is 1 - alignment, and k - 1 of
    its rows are independent there. With two task rows the sine of the angle from b to a vanishes there too, with a
    change of sign, and also where a and b are opposed.
    """

    arm: MountedArm
    E: Array | None

    @cached_property
    def _kernel(self) -> Kernel:
        arm = self.arm
        E = None if self.E is None else self.E.tolist()

        def function(joints: Vector) -> list[Scalar]:
            rows: list[Scalar] = []
            for mode in configuration_of(arm, joints, {}, E).modes:
                rows += [*misalignment(mode.a, mode.b), sine(mode.a, mode.b) if arm.k == 2 else 0.0 * mode.frequency]
            return rows

        gain = "none" if self.E is None else self.E.tobytes().hex()
        return kernel_of(function, arm.n, f"misalignment\n{model_digest(arm)}\nE {gain}", derivative=True)

    def _evaluate(self, joints: Array) -> tuple[Array, Array]:
        S, n = joints.shape
        m, rows = self.arm.m, self.arm.k + 1
        results = self._kernel(np.ascontiguousarray(joints.T))
        values, slopes = results[: m * rows], results[m * rows :]
        return values.T.reshape(S, m, rows), np.moveaxis(slopes.reshape(m, rows, n, S), 3, 0)

    def __call__(self, joints: Array) -> tuple[Array, Array]:
        """d of every mode, shape (S, m, k), and its slopes by the arm joints, shape (S, m, k, n), of joints (S, n)."""
        values, slopes = self._evaluate(joints)
        return values[..., :-1], slopes[..., :-1, :]

    def sine(self, joints: Array) -> tuple[Array, Array]:
        """Sine of the angle from b to a of every mode, shape (S, m), and its slopes, shape (S, m, n), where k = 2."""
        values, slopes = self._evaluate(joints)
        return values[..., -1], slopes[..., -1, :]


def sine(a: Vector, b: Vector) -> Scalar:
    """Sine of the angle from b to a in a plane; 0 where one of them vanishes."""
    return sub(mul(b[0], a[1]), mul(b[1], a[0])) / or_one(mul(norm(a), norm(b)))


def make_misalignment(plant: Plant, loop: Asked) -> Misalignment:
    """The equations for a plant, checked. Raises InputError where robust configurations have no meaning."""
    check_plant(plant)
    arm = plant.arm
    if arm.m == 0:
        raise InputError(f"robust configurations: {plant.name} has a rigid base, no mode. Give one with base joints.")
    if arm.k == 1:
        raise InputError(
            f"robust configurations: {plant.name} has one task row; its modes are positive real where robustness is "
            "positive, not on a line. Draw flexbase sweep."
        )
    check_measures(plant, (MEASURES["alignment"],), "robust configurations")
    return Misalignment(arm, loop_on(arm, loop).E)


def tips_of(plant: Plant, joints: Array) -> Array:
    """Task coordinates of the resting tip, shape (S, k), of arm joints (S, n); the base at its equilibrium."""
    arm = plant.arm
    frames = forward(arm.mechanism, arm.parts.whole(arm.base.equilibrium.tolist(), unstack(joints, 1)))
    return np.broadcast_to(task_value(frames, arm.task), (len(joints), arm.k)).copy()
