"""A servo of the joints with a slow loop of the tip around it, or else loop shaping of the tip; all for changed robots.

A controller that holds a model of a hardly damped base resonates with that model, and often loses the base that is 20 %
off; a servo of the joints needs no such model, so it is tried first. Where it does not fit, three findings lead on.
What limits the static stiffness is the gain that rest and crossover share, so a lag gives more of it at rest. On the
paper's arm loop shaping of the tip loses changed robots nearly only to a softer base, so some designs are made for one.
And which share of the joints serves best beside the tip depends on the pose, so it is searched.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, partial
from typing import NamedTuple

import numpy as np

from flexbase.errors import Unsolvable
from flexbase.linear.discrete.coprime import coprime_controller
from flexbase.linear.discrete.system import Discrete
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.sampled.changes import Changed, changed_pose
from flexbase.sampled.controller import SampledController
from flexbase.sampled.judged import GOOD_MARGIN, Judged, Robots, robots_at
from flexbase.synthesis.registry import Margin, hardware_method
from flexbase.synthesis.search.servo import Slow, joint_servo
from flexbase.synthesis.search.shaping import Weight, check_stiff, design_plant, task_shape
from flexbase.synthesis.search.stiffest import best_of, stiffest


class Stage(NamedTuple):
    """Designs under one weight, tried together; the next is tried where the tip is somewhere softer than `enough` Kp.

    shapes : factor on the base stiffness designed for, joint weight beside the tip error; none: servos of the joints
    slow : the loop around these
    enough : 0: that anything is accepted is enough
    """

    weight: Weight
    shapes: tuple[tuple[float, float], ...] = ()
    slow: Slow | None = None
    enough: float = 0.15


STAGES = (
    Stage(Weight(), slow=Slow(10.0, 30.0)),
    Stage(Weight(), slow=Slow(5.0, 20.0)),
    Stage(Weight(3.0, 60.0), ((0.85, 1.2), (1.0, 0.7), (0.85, 0.0), (0.92, 0.3))),
    # where the arm shakes a base that is hardly damped: a lead, more margin for three to nine times the noise
    Stage(Weight(lead=3.0, corner=100.0), slow=Slow(5.0, 20.0)),
    Stage(Weight(lead=8.0, corner=150.0), slow=Slow(5.0, 20.0)),
    # where the base mode is strong: tip error alone, which a slow gain does not turn against the joints
    Stage(Weight(10.0, 20.0), ((1.0, 0.0), (0.9, 0.0), (0.85, 0.15))),
    Stage(Weight(10.0, 10.0), ((1.0, 0.0), (0.9, 0.0)), enough=0.0),
    # where 0.1 rad turns the sign of a direction of the tip: nothing that corrects it bears that, the joints alone do
    Stage(Weight(10.0, 20.0)),
)
SIZES = (1.0, 0.6, 0.36, 0.22, 0.13)  # of the task stiffness, for the servos
HALF = 0.5
FACTOR = 1.1
HALVINGS = 3


@hardware_method("robust", "a joint servo and a slow loop of the tip: holds changed robots; needs no accelerometer")
def robust(
    pose: Pose, sensing: Sensing, gains: Gains, *, margin: Margin = GOOD_MARGIN, stages: Sequence[Stage] = STAGES
) -> SampledController:
    """The stiffest accepted of servos of the joints, the tip around them, and of loop shaping of tip and joints.

    Accepted as in `coprime`: stable here and on all changed robots, both disk margins at least `margin`. What takes
    away less than half of a tip error is an answer only where nothing else is accepted. Where nothing is accepted the
    nearest is returned, and `notes["accepted"]` is false.

    stages : tried in turn until the tip is stiff enough for one
    Raises Infeasible where no controller exists at all.
    """
    check_stiff(pose, gains)
    robots = robots_at(pose, sensing)
    asked = float(np.linalg.eigvalsh(gains.stiffness)[0])
    found: list[Judged] = []

    @cache
    def model(base: float) -> tuple[Pose, Discrete]:
        there = changed_pose(pose, Changed("design", base_stiffness=base))
        return there, design_plant(there, sensing)

    def shaped(scale: float, weight: Weight, base: float, joints: float) -> Judged | None:
        there, plant = model(base)
        shape = task_shape(there, gains, scale, joints, weight.sampled(sensing.step))
        try:
            central, b_opt = coprime_controller(shape.around(plant), FACTOR)
        except Unsolvable:
            return None
        notes = {"b_opt": b_opt, "scale": scale, "joint_weight": joints, "base_stiffness_factor": base}
        return _trial(robots, shape.unfold(central), weight, notes)

    for weight, shapes, slow, enough in stages:
        if not shapes:
            found += _servos(robots, gains, margin, weight, slow)
        for base, joints in shapes:
            attempt = partial(shaped, weight=weight, base=base, joints=joints)
            found += stiffest(attempt, margin, halvings=HALVINGS, softest=_reached(found, margin))
        if (stiff := _reached(found, margin)) > 0.0 and stiff >= enough * asked:
            break
    return best_of(_correcting(found, margin) or found, margin, pose)


def _correcting(found: Sequence[Judged], margin: float) -> list[Judged]:
    """Those that seem accepted and take away half of a tip error: less is hardly a loop of the tip."""
    return [one for one in found if one.seems_accepted(margin) and one.correction >= HALF]


def _reached(found: Sequence[Judged], margin: float) -> float:
    """Stiffness of the tip, of the stiffest that seems accepted and corrects it; 0 if none does."""
    return max((one.stiffness for one in _correcting(found, margin)), default=0.0)


def _servos(robots: Robots, gains: Gains, margin: float, weight: Weight, slow: Slow | None) -> list[Judged]:
    """Servos of one weight, down to the first that is accepted."""
    pose, sensing = robots.pose, robots.sensing
    tried: list[Judged] = []
    for scale in SIZES:
        try:
            system, b_opt = joint_servo(pose, sensing, gains, scale, weight.sampled(sensing.step), slow)
        except Unsolvable:
            continue
        notes = {"b_opt": b_opt, "scale": scale, "tip_speed_rad_s": slow.speed if slow else 0.0}
        tried.append(_trial(robots, system, weight, notes))
        if tried[-1].seems_accepted(margin):
            break
    return tried


def _trial(robots: Robots, system: Discrete, weight: Weight, notes: dict[str, float]) -> Judged:
    """The notes of a shape have its joint weight and base; a servo's do not."""
    told = {**notes, "ratio": weight.ratio, "turn_rad_s": weight.turn, "lead": weight.lead}
    return Judged(SampledController("robust", robots.pose, robots.sensing, system, None, told), robots)
