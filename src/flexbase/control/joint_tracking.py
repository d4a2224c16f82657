"""Joint tracking for the move: inverse dynamics of the arm as if its base were rigid."""

from __future__ import annotations

from dataclasses import dataclass

from flexbase.control.measured import Measured
from flexbase.control.trajectories import JointPath
from flexbase.dynamics.forces import inverse_dynamics
from flexbase.dynamics.kinematics import forward
from flexbase.plant import Pose
from flexbase.trace.algebra import Vector

BANDWIDTH = 60.0  # rad/s: a fifth of the base's natural frequency in the paper's example


@dataclass(frozen=True)
class JointTracking:
    """tau = arm part of M q'' + h + g at (qbar_p, q_a), for the path's acceleration, critically damped about it."""

    goal: Pose
    path: JointPath
    bandwidth: float = BANDWIDTH

    def torque(self, seen: Measured) -> Vector:
        """Arm torques, n scalars (or batches)."""
        arm, rest = self.goal.arm, self.goal.equilibrium.tolist()
        parts, still = arm.parts, (0.0,) * arm.m
        wanted, rates, accelerations = self.path.at(seen.time)
        corrected = tuple(
            acceleration + 2.0 * self.bandwidth * (rate - seen_rate) + self.bandwidth**2 * (joint - seen_joint)
            for joint, rate, acceleration, seen_joint, seen_rate in zip(
                wanted, rates, accelerations, seen.joints, seen.rates, strict=True
            )
        )
        frames = forward(arm.mechanism, parts.whole(rest, seen.joints))
        speeds, changes = parts.whole(still, seen.rates), parts.whole(still, corrected)
        return parts.arm(inverse_dynamics(frames, speeds, changes, arm.gravity.tolist()))
