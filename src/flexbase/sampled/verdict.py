"""Will it run? The verdict on a sampled controller at a pose, as the sensing declares the loop.  [theory §10]"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from flexbase.linear.discrete.disk_margin import disk_margin
from flexbase.linear.discrete.loop_margins import delay_margin, lag_margin
from flexbase.linear.margins import algebraic_loop_radius, algebraic_loop_radius_per_joint
from flexbase.plant import Pose
from flexbase.sampled.closed import (
    close_loop,
    dynamic_stiffness,
    loop_gain,
    sensitivities,
    tip_correction,
    tip_stiffness,
)
from flexbase.sampled.controller import SampledController
from flexbase.sampled.plant import Changed, changed_pose, eight_changes

GOOD_MARGIN = 0.3  # disk margin: gains from 0.74 to 1.35, phases to 17 degrees


@dataclass(frozen=True)
class HardwareVerdict:
    """What a sampled loop does at a pose, and what it bears.

    stable : spectral radius below 1
    disk_margin_torque, disk_margin_sensor : alpha with all torque channels, or all sensors used, perturbed at once
    delay_margin_s, lag_margin_s : further delay and first-order lag of all torques; None: no limit, or unstable
    algebraic_loop_radius, algebraic_loop_radius_per_joint : of the gain on accelerations inside; None without one
    worst_radius, worst_change : largest spectral radius over the changed robots, and which one
    survives : whether all of the changed robots are stable; failed : those that are not
    tip_stiffness : smallest static stiffness at the tip [N/m or N m/rad]; None if unstable
    dynamic_stiffness : smallest at any frequency; None if unstable
    tip_correction : share of a constant tip error, unseen by the joints, that is taken away at rest; None if unstable
    time_constant_s : of the slowest motion; None if unstable
    """

    method: str
    stable: bool
    spectral_radius: float
    disk_margin_torque: float
    disk_margin_sensor: float
    delay_margin_s: float | None
    lag_margin_s: float | None
    algebraic_loop_radius: float | None
    algebraic_loop_radius_per_joint: float | None
    worst_radius: float
    worst_change: str
    survives: bool
    failed: tuple[str, ...]
    tip_stiffness: float | None
    dynamic_stiffness: float | None
    tip_correction: float | None
    time_constant_s: float | None

    @property
    def has_margin(self) -> bool:
        """Whether both disk margins are good."""
        return min(self.disk_margin_torque, self.disk_margin_sensor) >= GOOD_MARGIN

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return asdict(self)

    def summary(self) -> str:
        """What a person needs, in four lines."""
        if not self.stable:
            return f"{self.method}: unstable as it runs, spectral radius {self.spectral_radius:.4f} a sample"
        delay = "" if self.delay_margin_s is None else f"further delay {1e3 * self.delay_margin_s:.3f} ms; "
        kept = "survives all changes of the robot" if self.survives else f"fails with {', '.join(self.failed)}"
        return (
            f"{self.method}: stable, time constant {1e3 * (self.time_constant_s or 0.0):.1f} ms\n"
            f"  disk margin {self.disk_margin_torque:.3f} at torques, {self.disk_margin_sensor:.3f} at sensors\n"
            f"  {delay}{kept}\n"
            f"  tip stiffness {self.tip_stiffness:.4g} N/m at rest, {self.dynamic_stiffness:.4g} N/m at worst; "
            f"corrects {100.0 * (self.tip_correction or 0.0):.0f} % of a tip error that the joints do not show"
        )


def hardware_verdict(
    controller: SampledController,
    pose: Pose | None = None,
    changes: Sequence[Changed] | None = None,
    *,
    brief: bool = False,
) -> HardwareVerdict:
    """The verdict on a controller at the pose it was made for, or at another one.

    changes : robots that differ from the model; `eight_changes` if left out
    brief : leave out what takes longest: delay and lag margins and the radii of the algebraic loop, None then
    """
    here = controller.pose if pose is None else pose
    loop = close_loop(here, controller)
    step, radius = controller.sensing.step, loop.radius
    stable = radius < 1.0
    tried = eight_changes(here.arm.n) if changes is None else tuple(changes)
    radii = [close_loop(changed_pose(here, change), controller).radius for change in tried]
    worst = int(np.argmax(radii)) if radii else -1
    margins = [disk_margin(one).alpha for one in sensitivities(here, controller)] if stable else [0.0, 0.0]
    around = None if brief or not stable else loop_gain(here, controller)
    E = None if brief else controller.E
    return HardwareVerdict(
        method=controller.name,
        stable=stable,
        spectral_radius=radius,
        disk_margin_torque=margins[0],
        disk_margin_sensor=margins[1],
        delay_margin_s=None if around is None else _finite(delay_margin(around)),
        lag_margin_s=None if around is None else _finite(lag_margin(around)),
        algebraic_loop_radius=None if E is None else algebraic_loop_radius(here, E),
        algebraic_loop_radius_per_joint=None if E is None else algebraic_loop_radius_per_joint(here, E),
        worst_radius=max(radii, default=radius),
        worst_change=tried[worst].label if radii else "none",
        survives=stable and all(one < 1.0 for one in radii),
        failed=tuple(change.label for change, one in zip(tried, radii, strict=True) if one >= 1.0),
        tip_stiffness=tip_stiffness(here, controller) if stable else None,
        dynamic_stiffness=dynamic_stiffness(here, controller) if stable else None,
        tip_correction=tip_correction(here, controller) if stable else None,
        time_constant_s=-step / float(np.log(radius)) if stable and radius > 0.0 else None,
    )


def _finite(margin: float) -> float | None:
    return margin if np.isfinite(margin) else None
