"""Many sampled loops at once: sensors, controllers, drives and a plant, one sample after the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.statics import gravity_torques
from flexbase.errors import InputError
from flexbase.plant import Pose
from flexbase.sampled.controller import SampledController
from flexbase.simulation.hardware.drives import Drives
from flexbase.simulation.hardware.laws import Settling, Tracking
from flexbase.simulation.hardware.senses import Senses
from flexbase.simulation.plants.physics import Physics
from flexbase.simulation.settling import FASTEST


@dataclass(frozen=True, eq=False)
class Record:
    """What happened, sample by sample: q, rates (samples, runs, N); true tip error (.., k); torque as given (.., n)."""

    q: Array
    rates: Array
    tip_error: Array
    torque: Array


class SampledLoops:
    """Runs that share their arm's structure, their sensing and their clock. Mutable: `go` moves it on."""

    def __init__(
        self,
        controllers: Sequence[SampledController],
        goals: Sequence[Pose],
        physics: Physics,
        *,
        start: Array,
        tracking: Tracking | None = None,
        seed: int = 0,
    ) -> None:
        """start : joints, shape (runs, N), at rest; tracking : in place of the controllers for as long as it says."""
        self._sensing, arm = controllers[0].sensing, goals[0].arm
        check_causal(controllers)
        holding = np.array([_holding(one, goal.q) for one, goal in zip(controllers, goals, strict=True)])
        before = (
            np.array([_holding(one, q) for one, q in zip(controllers, start, strict=True)]) if tracking else holding
        )
        self._settling = Settling(controllers, np.stack([goal.joints for goal in goals]), holding)
        self._senses = Senses(arm, self._sensing, len(goals), seed)
        self._drives = Drives(self._sensing, before)
        self._physics, self._tracking = physics, tracking
        self.alive = np.ones(len(goals), dtype=bool)
        self.ended = np.full(len(goals), -1)  # sample at which a run diverged
        self.sample = 0

    @property
    def saturated(self) -> Array:
        """Samples in which a drive gave another torque than it was asked for, shape (runs,)."""
        return np.asarray(self._drives.saturated)

    def go(self, tip_force: Array) -> Record:
        """As many samples as there are tip forces, shape (samples, k); each is recorded at its begin."""
        parts = []
        with np.errstate(all="ignore"):  # runs that diverge are ended by their speed
            for force in tip_force:
                parts.append(self._one(np.broadcast_to(force, (len(self.alive), len(force)))))
        return Record(*(np.stack(column) for column in zip(*parts, strict=True)))

    def _one(self, force: Array) -> tuple[Array, Array, Array, Array]:
        seen = self._physics.observe(self._drives.next, force)
        fast = ~(np.abs(seen.rates).max(axis=1) <= FASTEST)
        self.ended[fast & self.alive] = self.sample
        self.alive &= ~fast
        tip, joints, accelerations = self._senses.read(seen)
        if self._tracking is not None and self.sample < self._tracking.samples:
            command = self._tracking.torque(self.sample * self._sensing.step, joints)
        else:
            command = self._settling.torque(tip, joints, accelerations)
        command[~self.alive] = 0.0
        torque = self._drives.apply(command)
        self._physics.advance(torque, force, self.alive)
        self.sample += 1
        return seen.q, seen.rates, seen.tip_error, torque


def check_causal(controllers: Sequence[SampledController]) -> None:
    """Raise InputError for an acceleration that would depend on the torque that it decides."""
    sensing = controllers[0].sensing
    ideal = sensing.acceleration == "accelerometer" and sensing.accelerometer_lag == 0.0
    n = controllers[0].pose.arm.n
    for one in controllers:
        if ideal and sensing.compute_delay == 0 and np.any(one.system.D[:, -n:]):
            raise InputError(
                f"{one.name}: without compute_delay and accelerometer_lag the measured acceleration depends "
                "on the torque that it decides. Give one of them."
            )


def _holding(controller: SampledController, q: Array) -> Array:
    """Arm torques against gravity, by the controller's own model of the robot."""
    arm = controller.pose.arm
    return arm.parts.arm(gravity_torques(arm, q))
