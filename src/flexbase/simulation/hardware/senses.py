"""What a sampled controller gets to read: late, held, noisy, in counts."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.model.mounted import MountedArm
from flexbase.model.sensing import Sensing
from flexbase.simulation.plants.physics import Seen


class Senses:
    """The sensors of many runs; read once a sample.

    Encoders round to the nearest count of their absolute position. The task sensor's noise is new with
    every value that it delivers; each run draws its own, the same for every physics.
    """

    def __init__(self, arm: MountedArm, sensing: Sensing, runs: int, seed: int) -> None:
        self._sensing, self._parts = sensing, arm.parts
        counts = sensing.encoder_counts
        turns = np.array([2.0 * np.pi if unit == "rad" else 1.0 for unit in arm.joint_units])
        self._count = None if counts is None else turns / counts
        self._random = [np.random.default_rng([seed, run]) for run in range(runs)]
        self._late: list[Array] = []  # tip errors on their way, the oldest first
        self._held: Array | None = None
        self._sample = 0

    def read(self, seen: Seen) -> tuple[Array, Array, Array]:
        """Tip error (runs, k), joints (runs, n), accelerations (runs, n) as the controller gets them at this sample."""
        sensing = self._sensing
        noise = np.stack([random.standard_normal(seen.tip_error.shape[1]) for random in self._random])
        if not self._late:
            self._late = [seen.tip_error] * sensing.task_delay  # at rest here before
        self._late.append(seen.tip_error + sensing.task_noise * noise)
        arrived = self._late.pop(0)
        if self._held is None or self._sample % sensing.task_every == 0:
            self._held = arrived
        self._sample += 1
        return self._held, self._joints(seen), self._accelerations(seen)

    def _joints(self, seen: Seen) -> Array:
        joints = self._parts.arm(seen.q)
        return joints if self._count is None else np.asarray(np.round(joints / self._count) * self._count)

    def _accelerations(self, seen: Seen) -> Array:
        noise = np.stack([random.standard_normal(seen.acceleration.shape[1]) for random in self._random])
        return np.asarray(seen.acceleration + self._sensing.acceleration_noise * noise)
