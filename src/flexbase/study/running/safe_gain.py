"""How stiff may the task-space loop be? The highest gain at which a method's controller is safe, or merely stable."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from flexbase.errors import FlexbaseError, InputError
from flexbase.linear.discrete.disk_margin import disk_margin
from flexbase.model.sensing import TYPICAL, Sensing, checked_sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.sampled.closed import close_loop, sensitivities, tip_stiffness
from flexbase.sampled.controller import SampledController
from flexbase.sampled.plant import changed_pose, eight_changes
from flexbase.sampled.verdict import GOOD_MARGIN
from flexbase.synthesis import controller_for

SMALLEST, LARGEST, LOOKS = 1e-3, 1e2, 11  # scales looked at first: a factor of about 3 apart
HALVINGS = 5  # of the last factor: to 4 %
AS_GIVEN: dict[str, dict[str, Any]] = {"constant": {"scales": (1.0,), "most": 50}, "sampled": {"most": 40}}
UNSTABLE, STABLE, SAFE = range(3)


@dataclass(frozen=True)
class SafeGain:
    """The largest scale s of the gains (s Kp, sqrt(s) Kv) up to which a method was found to do; None: at none.

    safe : stable, both disk margins 0.3 or more, and stable on all changed robots; stable : merely stable
    safe_stiffness : smallest static stiffness of the tip at the safe scale [N/m or N m/rad]
    unsafe_below : a scale below the safe one that is not safe was seen, so the answer is no simple bound
    """

    method: str
    safe: float | None
    stable: float | None
    safe_stiffness: float | None
    unsafe_below: bool

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return asdict(self)

    def summary(self) -> str:
        """One line."""
        safe = "none" if self.safe is None else f"{self.safe:.3g} times the gains, {self.safe_stiffness:.3g} N/m"
        stable = "none" if self.stable is None else f"{self.stable:.3g} times"
        return f"{self.method}: safe up to {safe}; stable up to {stable}"


def safe_gain(pose: Pose, method: str = "none", sensing: Sensing | None = None, gains: Gains | None = None) -> SafeGain:
    """The highest safe and stable scale from 0.001 to 100, the method designing anew at each scale.

    `constant` keeps to the scale that is asked; the loop-shaping methods choose a softer one where it is too much.
    Looked for on a grid from the top down, then bisected between the first that does and its neighbour above.
    Raises InputError.
    """
    used = pose.arm.gains if gains is None else gains
    if used is None:
        raise InputError(f"{pose.plant.name}: no task gains. Add a [control] table to the project, or give gains.")
    loop = checked_sensing(sensing or pose.arm.sensing or TYPICAL, pose.arm.n)
    changed = [changed_pose(pose, change) for change in eight_changes(pose.arm.n)]
    known: dict[float, tuple[int, SampledController | None]] = {}

    def grade(scale: float) -> int:
        if scale not in known:
            scaled = Gains(scale * used.stiffness, np.sqrt(scale) * used.damping)
            known[scale] = _graded(pose, method, loop, scaled, changed)
        return known[scale][0]

    scales = np.geomspace(SMALLEST, LARGEST, LOOKS).tolist()
    stable = _highest(scales, lambda scale: grade(scale) >= STABLE)
    safe = _highest(scales, lambda scale: grade(scale) == SAFE)
    if safe is None:
        return SafeGain(method, None, stable, None, False)
    controller = known[safe][1]
    holes = any(grade_ < SAFE for scale, (grade_, _) in known.items() if scale < safe)
    return SafeGain(method, safe, stable, None if controller is None else tip_stiffness(pose, controller), holes)


def _highest(scales: list[float], does: Any) -> float | None:
    above = None
    for scale in reversed(scales):
        if does(scale):
            break
        above = scale
    else:
        return None
    low, high = scale, above
    for _ in range(HALVINGS if high is not None else 0):
        middle = float(np.sqrt(low * high))  # type: ignore[operator]
        low, high = (middle, high) if does(middle) else (low, middle)
    return float(low)


def _graded(
    pose: Pose, method: str, sensing: Sensing, gains: Gains, changed: list[Pose]
) -> tuple[int, SampledController | None]:
    try:
        controller = controller_for(pose, method, sensing, gains, **AS_GIVEN.get(method, {}))
    except InputError:
        raise
    except (FlexbaseError, np.linalg.LinAlgError):
        return UNSTABLE, None
    if close_loop(pose, controller).radius >= 1.0:
        return UNSTABLE, controller
    held = all(close_loop(one, controller).radius < 1.0 for one in changed)
    if not held or min(disk_margin(side).alpha for side in sensitivities(pose, controller)) < GOOD_MARGIN:
        return STABLE, controller
    return SAFE, controller
