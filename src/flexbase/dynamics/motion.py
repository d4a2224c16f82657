"""The equation of motion of an arm on its base, on any number type.  [U03 eq 1, 2, 11]"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from flexbase.dynamics.forces import bias_forces
from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import Frames, task_jacobian
from flexbase.dynamics.variation import varied_base
from flexbase.model.mounted import MountedArm
from flexbase.trace.algebra import Matrix, Scalar, Vector, matsub, matvec, minus, mul, plus, scale, transpose

AS_IT_IS: Mapping[str, Scalar] = {}  # no parameter is varied


class Equation(NamedTuple):
    """M q'' = force in one state: inertia, shape (N, N), and force, shape (N,)."""

    inertia: Matrix
    force: Vector


def equation_of_motion(
    arm: MountedArm,
    frames: Frames,
    q: Vector,
    rates: Vector,
    torque: Vector,
    rest: Vector,
    *,
    tip_force: Vector = (),
    varied: Mapping[str, Scalar] = AS_IT_IS,
) -> Equation:
    """M q'' = [Kp (rest - q_p) - Dp q_p'; tau] + J^T F - h - g - friction.  [U03 eq 1, 2]

    frames : at q, with links as they are; varied : what differs of the base (`varied_base`)
    torque : tau of the arm joints, n; rest : of the base springs, m
    tip_force : F on the tool in the task's rows, k, or nothing
    """
    parts, friction = arm.parts, arm.mechanism.friction
    spring = minus(
        matvec(varied_base(arm, "stiffness", varied), minus(rest, parts.base(q))),
        matvec(varied_base(arm, "damping", varied), parts.base(rates)),
    )
    force: Vector = parts.whole(spring, tuple(torque))
    if len(tip_force):
        force = plus(force, matvec(transpose(task_jacobian(frames, arm.task.indices)), tip_force))
    force = minus(force, [mul(float(c), rate) for c, rate in zip(friction, rates, strict=True)])
    return Equation(mass_matrix(frames), minus(force, bias_forces(frames, rates, tuple(arm.gravity.tolist()))))


def under_gain(arm: MountedArm, inertia: Matrix, E: Matrix | None, share: Scalar = 1.0) -> Matrix:
    """M - blkdiag(0, E), so that a torque E q_a'' is met exactly, not fed back.  [U03 eq 11]

    share : factor on E
    """
    if E is None:
        return inertia
    return matsub(inertia, arm.parts.on_arm(tuple(scale(share, row) for row in E)))
