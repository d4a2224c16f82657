"""Trying controllers at one pose: the plants that they must stabilise, made once, and what each achieves on them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from flexbase.control.hardware import GOOD_MARGIN
from flexbase.control.sampled_controller import SampledController
from flexbase.control.sampled_loop import close_loop, sensitivities, tip_stiffness
from flexbase.control.sampled_plant import Changed, changed_pose, eight_changes
from flexbase.linear.disk_margin import disk_margin
from flexbase.plant import Pose


@dataclass(frozen=True, eq=False)
class Trial:
    """A controller, and what it does at its pose and on changed robots; each figure computed when asked for.

    changes : robots that it must also hold
    """

    controller: SampledController
    changed: tuple[Pose, ...]

    @cached_property
    def radius(self) -> float:
        """Spectral radius of a sample."""
        return close_loop(self.controller.pose, self.controller).radius

    @cached_property
    def worst_radius(self) -> float:
        """Largest spectral radius over the changed robots."""
        return max((close_loop(pose, self.controller).radius for pose in self.changed), default=self.radius)

    @cached_property
    def margins(self) -> tuple[float, float]:
        """Disk margins at torques and sensors; 0 if unstable."""
        if self.radius >= 1.0:
            return 0.0, 0.0
        torque, sensor = sensitivities(self.controller.pose, self.controller)
        return disk_margin(torque).alpha, disk_margin(sensor).alpha

    @cached_property
    def stiffness(self) -> float:
        """Smallest static stiffness of the tip; 0 if unstable."""
        return tip_stiffness(self.controller.pose, self.controller) if self.radius < 1.0 else 0.0

    def accepted(self, margin: float = GOOD_MARGIN) -> bool:
        """Stable here and on all changed robots, with both disk margins."""
        return self.radius < 1.0 and self.worst_radius < 1.0 and min(self.margins) >= margin


def changed_poses(pose: Pose, changes: Sequence[Changed] | None = None) -> tuple[Pose, ...]:
    """The robots that a controller must also hold; `eight_changes` if left out."""
    return tuple(changed_pose(pose, change) for change in (eight_changes(pose.arm.n) if changes is None else changes))
