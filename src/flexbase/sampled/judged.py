"""Does this sampled loop run? A controller at a pose and on changed robots, each figure computed when asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from flexbase.linear.discrete.disk_margin import disk_margin, grid_of, structured_norm
from flexbase.linear.discrete.system import Discrete, feedback
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose
from flexbase.sampled.changes import Changed, changed_pose, eight_changes
from flexbase.sampled.closed import period_radius, plant_at_one_rate, plants_in_a_period, sensitivities
from flexbase.sampled.controller import SampledController
from flexbase.sampled.figures import FIGURES

GOOD_MARGIN = 0.3  # disk margin: gains from 0.74 to 1.35, phases to 17 degrees
CAUTION = 1.02  # a grid may miss the smallest margin by this
DRIFT = 1e-12  # a motion that dies out by less a sample: rounding decides on which side of 1 its radius lies
UNSTABLE, STABLE, ALMOST, SAFE = range(4)  # grades; almost: with margins, or on all changed robots, not both


@dataclass(frozen=True, eq=False)
class Robots:
    """The robot of a pose and the changed ones, as sampled plants: made once for all controllers that are tried there.

    labels : of the changed robots
    """

    pose: Pose
    sensing: Sensing
    labels: tuple[str, ...]
    changes: tuple[Changed, ...]
    _plants: dict[int, tuple[Discrete, ...]] = field(default_factory=dict, repr=False)

    @cached_property
    def at_one_rate(self) -> Discrete:
        """The pose's own robot, as `plant_at_one_rate`."""
        return plant_at_one_rate(self.pose, self.sensing)

    def plants(self, number: int) -> tuple[Discrete, ...]:
        """Those of `plants_in_a_period`: 0 for the robot of the pose, then the changed ones."""
        if number not in self._plants:
            there = self.pose if number == 0 else changed_pose(self.pose, self.changes[number - 1])
            self._plants[number] = tuple(plants_in_a_period(there, self.sensing))
        return self._plants[number]


def robots_at(pose: Pose, sensing: Sensing, changes: Sequence[Changed] | None = None) -> Robots:
    """The robots around a pose; `eight_changes` if none are given."""
    tried = eight_changes(pose.arm.n) if changes is None else tuple(changes)
    return Robots(pose, sensing, tuple(change.label for change in tried), tried)


@dataclass(frozen=True, eq=False)
class Judged:
    """A controller, and what it does at a pose and on the changed robots there."""

    controller: SampledController
    robots: Robots
    _kept: dict[object, object] = field(default_factory=dict, repr=False)

    @property
    def pose(self) -> Pose:
        """Where it is judged."""
        return self.robots.pose

    @cached_property
    def radius(self) -> float:
        """Spectral radius of a sample."""
        return self._radius(0)

    @property
    def stable(self) -> bool:
        """Whether it settles here."""
        return dies_out(self.radius)

    @cached_property
    def changed_radii(self) -> tuple[float, ...]:
        """Spectral radius on each changed robot."""
        return tuple(self._radius(i) for i in range(1, 1 + len(self.robots.labels)))

    @property
    def worst_radius(self) -> float:
        """Largest spectral radius over the changed robots."""
        return max(self.changed_radii, default=self.radius)

    @property
    def worst_change(self) -> str:
        """The changed robot that is nearest to instability, or beyond it."""
        return self.robots.labels[int(np.argmax(self.changed_radii))] if self.changed_radii else "none"

    @property
    def failed(self) -> tuple[str, ...]:
        """The changed robots on which it is unstable."""
        pairs = zip(self.robots.labels, self.changed_radii, strict=True)
        return tuple(label for label, radius in pairs if not dies_out(radius))

    @cached_property
    def survives(self) -> bool:
        """Whether it is stable here and on all changed robots; the first that is not decides."""
        return self.stable and all(dies_out(self._radius(i)) for i in range(1, 1 + len(self.robots.labels)))

    @cached_property
    def margins(self) -> tuple[float, float]:
        """Disk margins at torques and sensors; 0 if unstable."""
        if not self.stable:
            return 0.0, 0.0
        torque, sensor = sensitivities(self.pose, self.controller)
        return disk_margin(torque).alpha, disk_margin(sensor).alpha

    def has_margin(self, margin: float = GOOD_MARGIN) -> bool:
        """Whether both disk margins reach it."""
        return min(self.margins) >= margin

    def accepted(self, margin: float = GOOD_MARGIN) -> bool:
        """Stable here and on all changed robots, with both disk margins: safe, where the margin is the usual one."""
        return self.survives and self.has_margin(margin)

    @property
    def grade(self) -> int:
        """SAFE, ALMOST, STABLE or UNSTABLE."""
        return STABLE + int(self.has_margin()) + int(self.survives) if self.stable else UNSTABLE

    def figure(self, name: str) -> float | None:
        """A registered figure; None where it has no meaning."""
        if name not in self._kept:
            self._kept[name] = FIGURES[name].run(self)
        return self._kept[name]  # type: ignore[return-value]

    @property
    def stiffness(self) -> float:
        """Smallest stiffness of the tip at any frequency; 0 if unstable."""
        return self.figure("dynamic_stiffness") or 0.0

    @property
    def correction(self) -> float:
        """Share of a constant tip error that is taken away at rest; 0 if unstable."""
        return self.figure("tip_correction") or 0.0

    def seems_accepted(self, margin: float = GOOD_MARGIN) -> bool:
        """`accepted`, some times faster: margins on a grid only, against `margin` and 2 % more."""
        if ("seems", margin) not in self._kept:
            self._kept["seems", margin] = self.survives and all(
                _clears(L, CAUTION * margin) for L in self._gains_around()
            )
        return bool(self._kept["seems", margin])

    def _radius(self, number: int) -> float:
        if ("radius", number) not in self._kept:
            self._kept["radius", number] = period_radius(self.robots.plants(number), self.controller, self.pose.arm.k)
        return float(self._kept["radius", number])  # type: ignore[arg-type]

    def _gains_around(self) -> tuple[np.ndarray, np.ndarray]:
        """Loop gains at the torques and at the sensors used, over a grid of frequencies."""
        system, plant = self.controller.system, self.robots.at_one_rate
        used = [i for i in range(len(plant.C)) if np.any(system.B[:, i]) or np.any(system.D[:, i])]
        system, plant = system.select(inputs=used), plant.select(used)
        frequencies = grid_of(feedback(plant, system))
        P, K = plant.transfer_function(frequencies), system.transfer_function(frequencies)
        return K @ P, P @ K


def judged(controller: SampledController, pose: Pose | None = None, changes: Sequence[Changed] | None = None) -> Judged:
    """A controller at the pose it was made for, or at another one; what its maker found there is not computed again.

    changes : robots that differ from the model; `eight_changes` if left out
    """
    here = controller.pose if pose is None else pose
    made = controller.judged
    if changes is None and isinstance(made, Judged) and made.pose is here:
        return made
    return Judged(controller, robots_at(here, controller.sensing, changes))


def dies_out(radius: float) -> bool:
    """The linear verdict on a spectral radius of a sample: every motion dies out, and not by rounding alone."""
    return radius < 1.0 - DRIFT


def _shifted(L: np.ndarray) -> np.ndarray:
    eye = np.eye(L.shape[-1])  # I - L is regular: a stable loop has no pole on the unit circle
    return np.asarray(np.linalg.inv(eye - L) - 0.5 * eye)


def _clears(L: np.ndarray, margin: float) -> bool:
    """Whether mu((I - L)^-1 - I/2) <= 1 / margin everywhere; channels are balanced only where that is needed."""
    shifted = _shifted(L)
    large = np.linalg.norm(shifted, 2, axis=(-2, -1)) > 1.0 / margin
    return not np.any(large) or float(structured_norm(shifted[large]).max()) <= 1.0 / margin
