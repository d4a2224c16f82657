"""Sampled normalised-coprime loop shaping on tip error and arm joints.  [theory §10]"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexbase.control.hardware import GOOD_MARGIN
from flexbase.control.sampled_controller import SampledController
from flexbase.design.hardware.registry import hardware_method
from flexbase.design.hardware.shaping import design_plant, task_shape
from flexbase.design.hardware.trial import Trial, changed_poses
from flexbase.errors import Infeasible
from flexbase.linear.coprime import coprime_controller
from flexbase.linear.discrete import spectral_radius
from flexbase.linear.tustin import balanced_truncation
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose

JOINT_WEIGHTS = (0.0, 0.5)
LOWEST = 1e-3  # of the task stiffness: a softer loop is no answer
HALVINGS = 7  # of the logarithmic interval of the scale: to 3 %
FACTOR = 1.1

Attempt = Callable[[float, float], Trial | None]  # scale, joint weight


@hardware_method("coprime", "loop shaping: as stiff as margins and changed robots allow; needs no accelerometer")
def coprime(
    pose: Pose,
    sensing: Sensing,
    gains: Gains,
    *,
    scale: float | None = None,
    margin: float = GOOD_MARGIN,
    order: int | None = None,
) -> SampledController:
    """The stiffest accepted of central controllers of the normalised coprime factors; `notes` reports b_opt.

    Shaped outputs are scale Kp e and c scale Kp Jv dq_a with c in {0, 0.5}. Accepted: stable at the pose and on the
    eight changed robots, disk margins of `margin` at torques and sensors. Where nothing is accepted the best is
    returned, and `notes["accepted"]` is false.

    scale : of the task stiffness, at most 1 where it is searched; given, no search
    order : states of the controller after balanced truncation, verified like the others; all if left out
    Raises Infeasible where no controller exists at all, or the asked order is not among 1 to the full order.
    """
    changed = changed_poses(pose)

    def attempt(size: float, weight: float) -> Trial | None:
        try:
            return Trial(coprime_at(pose, sensing, gains, size, weight, order=order), changed)
        except np.linalg.LinAlgError:
            return None

    found: list[Trial] = []
    for weight in JOINT_WEIGHTS:
        tried = [attempt(scale, weight)] if scale is not None else _bisect(attempt, weight, margin)
        found += [one for one in tried if one is not None]
    if not found:
        raise Infeasible(f"{pose.plant.name}: no Riccati equation of the loop shaping has a solution at this pose.")
    best = max(found, key=lambda one: merit(one, margin))
    best.controller.notes["accepted"] = best.accepted(margin)
    return best.controller


def coprime_at(
    pose: Pose,
    sensing: Sensing,
    gains: Gains,
    scale: float,
    joint_weight: float,
    factor: float = FACTOR,
    order: int | None = None,
) -> SampledController:
    """One controller, not searched for. Raises numpy.linalg.LinAlgError where it does not exist, Infeasible."""
    shape = task_shape(pose, gains, scale, joint_weight)
    central, b_opt = coprime_controller(shape.around(design_plant(pose, sensing)), factor)
    if order is not None:
        if not 1 <= order <= central.order:
            raise Infeasible(f"order: {order} states asked, and the controller has {central.order}. Give 1 to that.")
        if spectral_radius(central.A) >= 1.0:
            raise np.linalg.LinAlgError("an unstable controller has no Gramians")
        central, _ = balanced_truncation(central, order)
    notes = {"b_opt": b_opt, "scale": scale, "joint_weight": joint_weight, "factor": factor, "order": central.order}
    return SampledController("coprime", pose, sensing, shape.unfold(central), None, notes)


def merit(trial: Trial, margin: float) -> tuple[float, float]:
    """Accepted before not; among accepted the stiffest, among others what is nearest to acceptance."""
    if trial.accepted(margin):
        return 1.0, trial.stiffness
    return 0.0, min(trial.margins) - 10.0 * max(trial.worst_radius - 1.0, 0.0) - 10.0 * max(trial.radius - 1.0, 0.0)


def _bisect(attempt: Attempt, weight: float, margin: float) -> list[Trial | None]:
    low, high = np.log(LOWEST), 0.0
    tried = [attempt(1.0, weight)]
    if tried[0] is not None and tried[0].accepted(margin):
        return tried
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        one = attempt(float(np.exp(middle)), weight)
        tried.append(one)
        if one is not None and one.accepted(margin):
            low = middle
        else:
            high = middle
    return tried
