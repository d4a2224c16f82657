"""Trying controllers at one pose: the plants that they must stabilise, made once, and what each achieves on them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from flexbase.linear.discrete.disk_margin import disk_margin, grid_of, structured_norm
from flexbase.linear.discrete.system import Discrete, feedback, spectral_radius
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose
from flexbase.sampled.closed import (
    dynamic_stiffness,
    plant_at_one_rate,
    plants_in_a_period,
    sensitivities,
    tip_correction,
)
from flexbase.sampled.controller import SampledController
from flexbase.sampled.plant import Changed, changed_pose, eight_changes
from flexbase.sampled.verdict import GOOD_MARGIN

CAUTION = 1.02  # a grid may miss the smallest margin by this


@dataclass(frozen=True, eq=False)
class Robots:
    """The robot of a design, first, and the changed ones that its controller must also hold, as sampled plants.

    plants : of each robot, those of `plants_in_a_period`; at_one_rate : the first as `plant_at_one_rate`
    """

    pose: Pose
    sensing: Sensing
    at_one_rate: Discrete
    plants: tuple[tuple[Discrete, ...], ...]


def robots_at(pose: Pose, sensing: Sensing, changes: Sequence[Changed] | None = None) -> Robots:
    """The robots around a pose; `eight_changes` if none are given."""
    tried = eight_changes(pose.arm.n) if changes is None else changes
    poses = [pose, *(changed_pose(pose, change) for change in tried)]
    at_one_rate = plant_at_one_rate(pose, sensing)
    return Robots(pose, sensing, at_one_rate, tuple(tuple(plants_in_a_period(one, sensing)) for one in poses))


def _shifted(L: np.ndarray) -> np.ndarray:
    eye = np.eye(L.shape[-1])
    return np.asarray(np.linalg.inv(eye - L) - 0.5 * eye)


def _clears(L: np.ndarray, margin: float) -> bool:
    """Whether mu((I - L)^-1 - I/2) <= 1 / margin everywhere; channels are balanced only where that is needed."""
    shifted = _shifted(L)
    large = np.linalg.norm(shifted, 2, axis=(-2, -1)) > 1.0 / margin
    return not np.any(large) or float(structured_norm(shifted[large]).max()) <= 1.0 / margin


@dataclass(frozen=True, eq=False)
class Trial:
    """A controller, and what it does at its pose and on the changed robots; each figure computed when asked for."""

    controller: SampledController
    robots: Robots
    _seen: dict[float, bool] = field(default_factory=dict, repr=False)

    @cached_property
    def radius(self) -> float:
        """Spectral radius of a sample."""
        return self._radius(self.robots.plants[0])

    @cached_property
    def worst_radius(self) -> float:
        """Largest spectral radius over the changed robots."""
        return max((self._radius(plants) for plants in self.robots.plants[1:]), default=self.radius)

    @cached_property
    def survives(self) -> bool:
        """Whether it is stable here and on all changed robots; the first that is not decides."""
        return self.radius < 1.0 and all(self._radius(plants) < 1.0 for plants in self.robots.plants[1:])

    @cached_property
    def margins(self) -> tuple[float, float]:
        """Disk margins at torques and sensors; 0 if unstable."""
        if self.radius >= 1.0:
            return 0.0, 0.0
        torque, sensor = sensitivities(self.robots.pose, self.controller)
        return disk_margin(torque).alpha, disk_margin(sensor).alpha

    @cached_property
    def stiffness(self) -> float:
        """Smallest stiffness of the tip at any frequency; 0 if unstable."""
        return dynamic_stiffness(self.robots.pose, self.controller) if self.radius < 1.0 else 0.0

    @cached_property
    def correction(self) -> float:
        """Share of a constant tip error that is taken away at rest; 0 if unstable."""
        return tip_correction(self.robots.pose, self.controller) if self.radius < 1.0 else 0.0

    def accepted(self, margin: float = GOOD_MARGIN) -> bool:
        """Stable here and on all changed robots, with both disk margins."""
        return self.survives and min(self.margins) >= margin

    def seems_accepted(self, margin: float = GOOD_MARGIN) -> bool:
        """`accepted`, some times faster: margins on a grid only, against `margin` and 2 % more."""
        if margin not in self._seen:
            self._seen[margin] = self.survives and self._seems_to_have(margin)
        return self._seen[margin]

    def _seems_to_have(self, margin: float) -> bool:
        return all(_clears(L, CAUTION * margin) for L in self._gains_around())

    def _gains_around(self) -> tuple[np.ndarray, np.ndarray]:
        """Loop gains at the torques and at the sensors used, over a grid of frequencies."""
        system, plant = self.controller.system, self.robots.at_one_rate
        used = [i for i in range(len(plant.C)) if np.any(system.B[:, i]) or np.any(system.D[:, i])]
        system, plant = system.select(inputs=used), plant.select(used)
        frequencies = grid_of(feedback(plant, system))
        P, K = plant.transfer_function(frequencies), system.transfer_function(frequencies)
        return K @ P, P @ K

    def _radius(self, plants: tuple[Discrete, ...]) -> float:
        k = self.robots.pose.arm.k
        first, *held = (feedback(plant, self.controller.system, external=k).A for plant in plants[:2])
        if not held:
            return spectral_radius(first)
        around = np.linalg.matrix_power(held[0], len(plants) - 1) @ first
        return float(spectral_radius(around) ** (1.0 / len(plants)))
