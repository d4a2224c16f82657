"""Constant gains on tip error, tip rate, joint rate and acceleration, all made for the sampled loop at once."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

import numpy as np

from flexbase.checks import Array
from flexbase.errors import Infeasible, InputError
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.requests import Says
from flexbase.sampled.controller import SampledController
from flexbase.sampled.judged import GOOD_MARGIN, judged
from flexbase.synthesis.methods.sampled import MATRICES, SampledProblem
from flexbase.synthesis.registry import Margin, hardware_method
from flexbase.synthesis.search.minimax import Found, descend

SCALES = (1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125)  # of the task stiffness, tried from the first
FIRST_FREE = ("E", "damping", "joint-damping")
ALL = (*FIRST_FREE, MATRICES)


@hardware_method(
    "constant",
    "constant gain matrices made for the sampled loop: no states but filters",
    as_given={"scales": (1.0,), "most": 50},
)
def constant(
    pose: Pose,
    sensing: Sensing,
    gains: Gains,
    *,
    margin: Margin = GOOD_MARGIN,
    scales: Annotated[tuple[float, ...], Says("of the task stiffness, tried in turn", written="G,G")] = SCALES,
    most: Annotated[int, Says("looks in a descent")] = 80,
) -> SampledController:
    """Task stiffness, and full matrices on tip rate, joint rate and acceleration; the stiffest accepted of `scales`.

    The objective and the descent are those of `sampled`: at the first scale with E and two scalars free, then with
    every entry; at the next from where the one before ended. Accepted: stable at the pose and on the eight changed
    robots, disk margins of `margin` at torques and sensors. Where nothing is accepted the one with the largest margin
    is returned, and `notes["accepted"]` is false.

    scales : factors on the stiffness, with their roots on the damping to start from; most : looks in a descent
    Raises InputError, Infeasible where no scale gives a stable loop.
    """
    if not scales or min(scales) <= 0.0:
        raise InputError(f"scales: {list(scales)} are not factors above 0. Give such as 1.0, 0.5.")
    best: tuple[float, SampledController] | None = None
    last: Array | None = None
    for scale in scales:
        controller, last = _at(pose, sensing, gains, scale, most, last)
        found = judged(controller)
        controller.notes["accepted"] = found.accepted(margin)
        controller = replace(controller, judged=found)
        if controller.notes["accepted"]:
            return controller
        if found.stable and (best is None or min(found.margins) > best[0]):
            best = min(found.margins), controller
    if best is None:
        raise Infeasible(f"{pose.plant.name}: no constant gains were found that hold this pose. Ask for a softer loop.")
    return best[1]


def _at(
    pose: Pose, sensing: Sensing, gains: Gains, scale: float, most: int, last: Array | None
) -> tuple[SampledController, Array]:
    """The controller at a scale and its unknowns; descends from those of the last scale where there are any."""
    softer = Gains(scale * gains.stiffness, scale**0.5 * gains.damping)
    whole = SampledProblem(pose, sensing, softer, ALL)
    looks = 0
    if last is None:
        first = SampledProblem(pose, sensing, softer, FIRST_FREE)
        rough = min((descend(first.look, start, most) for start in first.starts()[:2]), key=lambda one: one.value)
        last = np.concatenate([rough.x, np.zeros(len(whole.units) - len(rough.x))])
        looks = rough.looks
    fine = descend(whole.look, last, most)
    made = whole.controller(Found(fine.x, fine.value, 0), looks + fine.looks)
    return SampledController("constant", pose, sensing, made.system, made.E, {**made.notes, "scale": scale}), fine.x
