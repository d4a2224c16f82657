"""The built-in plant between two samples: torques held, Runge-Kutta of fourth order, on any number type."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from flexbase.dynamics.kinematics import Frames, forward
from flexbase.dynamics.motion import equation_of_motion
from flexbase.model.mounted import MountedArm
from flexbase.simulation.runge_kutta import State, runge_kutta
from flexbase.trace.algebra import Scalar, Vector, ldl, minus, scale, solve_ldl

Function = Callable[[Vector], Sequence[Scalar]]


class Forces(NamedTuple):
    """What does not change between two samples.

    rest : of the base springs, m; torque : of the arm, n; tip : force on the tool in the task's rows, k
    """

    rest: Vector
    torque: Vector
    tip: Vector


@dataclass(frozen=True, eq=False)
class Held:
    """Functions of one vector of scalars for a kernel or NumPy rows: a step, and what can be seen at its end."""

    arm: MountedArm

    @property
    def sizes(self) -> tuple[int, ...]:
        """Lengths of what goes into `look`: joints, rates, rest, torque, tip force."""
        arm = self.arm
        return (arm.N, arm.N, arm.m, arm.n, arm.k)

    def look(self, inputs: Vector) -> Sequence[Scalar]:
        """Tool position (3) and rotation (9, row by row), accelerations of the arm joints (n)."""
        q, rates, *rest = split(inputs, self.sizes)
        frames = forward(self.arm.mechanism, q)
        accelerations = self._accelerations(frames, rates, q, Forces(*rest))
        turned = [entry for row in frames.tool_rotation for entry in row]
        return [*frames.tool_position, *turned, *self.arm.parts.arm(accelerations)]

    def step(self, inputs: Vector) -> Sequence[Scalar]:
        """Joints, rates and lagged rates (N, N, n) after a time; in: `look`'s, lagged rates (n), time, 1/lag.

        The lag is the accelerometers': w' = (v - w)/T, and (v - w)/T is what they show.
        """
        arm = self.arm
        q, rates, rest, torque, tip, lagged, (time, pace) = split(inputs, (*self.sizes, arm.n, 2))
        held = Forces(rest, torque, tip)

        def slope(_: float, state: State) -> State:
            joints, speeds, seen = state
            frames = forward(arm.mechanism, joints)
            lag = scale(pace, minus(arm.parts.arm(speeds), seen))
            return speeds, self._accelerations(frames, speeds, joints, held), lag

        return [x for part in runge_kutta(slope, (q, rates, lagged), time) for x in part]

    def _accelerations(self, frames: Frames, rates: Vector, q: Vector, held: Forces) -> Vector:
        M, force = equation_of_motion(self.arm, frames, q, rates, held.torque, held.rest, tip_force=held.tip)
        return solve_ldl(*ldl(M), force)


def split(inputs: Vector, sizes: Sequence[int]) -> list[Vector]:
    """A vector in parts."""
    parts: list[Vector] = []
    begin = 0
    for size in sizes:
        parts.append(tuple(inputs[begin : begin + size]))
        begin += size
    return parts
