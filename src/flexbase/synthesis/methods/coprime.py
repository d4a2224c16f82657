"""Sampled normalised-coprime loop shaping on tip error and arm joints.  [theory §10]"""

from __future__ import annotations

from typing import Annotated

from flexbase.errors import Infeasible, Unsolvable
from flexbase.linear.discrete.coprime import coprime_controller
from flexbase.linear.discrete.system import spectral_radius
from flexbase.linear.discrete.tustin import balanced_truncation
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.requests import Says
from flexbase.sampled.controller import SampledController
from flexbase.sampled.judged import GOOD_MARGIN, Judged, robots_at
from flexbase.synthesis.registry import Margin, hardware_method
from flexbase.synthesis.search.shaping import design_plant, task_shape
from flexbase.synthesis.search.stiffest import best_of, stiffest

JOINT_WEIGHTS = (0.0, 0.5)
FACTOR = 1.1


@hardware_method("coprime", "loop shaping: as stiff as margins and changed robots allow; needs no accelerometer")
def coprime(
    pose: Pose,
    sensing: Sensing,
    gains: Gains,
    *,
    scale: Annotated[float | None, Says("of the task stiffness; searched if left out", written="G")] = None,
    margin: Margin = GOOD_MARGIN,
    order: Annotated[int | None, Says("states after truncation; all if left out")] = None,
) -> SampledController:
    """The stiffest accepted of central controllers of the normalised coprime factors; `notes` reports b_opt.

    Shaped outputs are scale Kp e and c scale Kp Jv dq_a with c in {0, 0.5}. Accepted: stable at the pose and on the
    eight changed robots, disk margins of `margin` at torques and sensors. Where nothing is accepted the best is
    returned, and `notes["accepted"]` is false.

    scale : of the task stiffness, at most 1 where it is searched; given, no search
    order : states of the controller after balanced truncation, verified like the others; all if left out
    Raises Infeasible where no controller exists at all, or the asked order is not among 1 to the full order.
    """
    robots = robots_at(pose, sensing)
    found: list[Judged] = []
    for weight in JOINT_WEIGHTS:

        def attempt(size: float, weight: float = weight) -> Judged | None:
            try:
                return Judged(coprime_at(pose, sensing, gains, size, weight, order=order), robots)
            except Unsolvable:
                return None

        found += stiffest(attempt, margin) if scale is None else [one for one in [attempt(scale)] if one is not None]
    return best_of(found, margin, pose)


def coprime_at(
    pose: Pose,
    sensing: Sensing,
    gains: Gains,
    scale: float,
    joint_weight: float,
    order: int | None = None,
) -> SampledController:
    """One controller, not searched for. Raises Unsolvable where it does not exist, Infeasible."""
    shape = task_shape(pose, gains, scale, joint_weight)
    central, b_opt = coprime_controller(shape.around(design_plant(pose, sensing)), FACTOR)
    if order is not None:
        if not 1 <= order <= central.order:
            raise Infeasible(f"order: {order} states asked, and the controller has {central.order}. Give 1 to that.")
        if spectral_radius(central.A) >= 1.0:
            raise Unsolvable("order: an unstable controller cannot be truncated. Leave the order out.")
        central, _ = balanced_truncation(central, order)
    notes = {"b_opt": b_opt, "scale": scale, "joint_weight": joint_weight, "order": central.order}
    return SampledController("coprime", pose, sensing, shape.unfold(central), None, notes)
