"""Task-space proportional-derivative control through the Jacobian transpose.  [U03 eq 18]"""

from __future__ import annotations

from dataclasses import dataclass

from flexbase.control.measured import Measured
from flexbase.dynamics.kinematics import forward, task_jacobian
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.trace.algebra import Vector, matvec, plus, scale, transpose


@dataclass(frozen=True)
class TaskPD:
    """tau = -Jv(qbar_p, q_a)^T (Kp y + Kv y') + the torque that holds the goal against gravity.

    Jv is taken at the base's rest position: its deflection is not measured.
    """

    goal: Pose
    gains: Gains

    def torque(self, seen: Measured) -> Vector:
        """Arm torques, n scalars (or batches)."""
        arm, rest = self.goal.arm, self.goal.equilibrium.tolist()
        rows = task_jacobian(forward(arm.mechanism, arm.parts.whole(rest, seen.joints)), arm.task.indices)
        Jv = tuple(map(arm.parts.arm, rows))
        pull = plus(
            matvec(self.gains.stiffness.tolist(), seen.tip_error), matvec(self.gains.damping.tolist(), seen.tip_rate)
        )
        return plus(scale(-1.0, matvec(transpose(Jv), pull)), self.goal.holding_torque.tolist())
