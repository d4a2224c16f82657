"""Loop shaping that is made for the changed robots: a lagged weight, and a softer base in the design than in the model.

Three findings stand behind it. On the paper's arm plain loop shaping loses changed robots nearly only to a softer
base, so some designs are made for one. What limits the static stiffness is the gain that rest and crossover share, so a
lag gives more of it at rest. And which share of the joints serves best depends on the pose, so it is searched.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, partial
from typing import NamedTuple

import numpy as np

from flexbase.control.hardware import GOOD_MARGIN
from flexbase.control.sampled_controller import SampledController
from flexbase.control.sampled_plant import Changed, changed_pose
from flexbase.design.hardware.registry import hardware_method
from flexbase.design.hardware.shaping import design_plant, slow_gain, task_shape
from flexbase.design.hardware.stiffest import best_of, stiffest
from flexbase.design.hardware.trial import Trial, robots_at
from flexbase.linear.coprime import coprime_controller
from flexbase.linear.discrete import Discrete
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose

SOFT = 0.3  # of the task stiffness: softer at the tip than this, the next stage is tried
FACTOR = 1.1
HALVINGS = 3


class Stage(NamedTuple):
    """A lag, and the shapes that are tried with it: factor on the base stiffness designed for, and joint weight.

    ratio : gain at rest over gain at speed; turn : where the gain at speed begins [rad/s]
    """

    ratio: float
    turn: float
    shapes: tuple[tuple[float, float], ...]


STAGES = (
    Stage(3.0, 60.0, ((0.85, 1.2), (1.0, 0.7), (0.85, 0.0), (0.92, 0.3))),
    # where the base mode is strong: tip error alone, which a slow gain does not turn against the joints
    Stage(10.0, 20.0, ((1.0, 0.0), (0.9, 0.0), (0.85, 0.15))),
    Stage(10.0, 10.0, ((1.0, 0.0), (0.9, 0.0))),
    # where the arm shakes a base that is hardly damped: the joints, beside which the tip error counts little
    Stage(3.0, 60.0, ((1.0, 3.0), (1.0, 10.0), (1.0, 30.0))),
)


@hardware_method("robust", "loop shaping for the changed robots: stiff where it is safe; needs no accelerometer")
def robust(
    pose: Pose, sensing: Sensing, gains: Gains, *, margin: float = GOOD_MARGIN, stages: Sequence[Stage] = STAGES
) -> SampledController:
    """The stiffest accepted of loop shaping designs over scale, share of the joints, and base stiffness designed for.

    Accepted as in `coprime`: stable here and on the eight changed robots, both disk margins at least `margin`. The
    weight on every signal is (s + turn)/(s + turn/ratio). Where nothing is accepted the nearest is returned, and
    `notes["accepted"]` is false.

    stages : lags and shapes; the next stage is tried where the tip stays softer than 0.3 Kp
    Raises Infeasible where no controller exists at all.
    """
    robots = robots_at(pose, sensing)
    soft = SOFT * float(np.linalg.eigvalsh(gains.stiffness)[0])
    found: list[Trial] = []
    reached = 0.0

    @cache
    def model(base: float) -> tuple[Pose, Discrete]:
        there = changed_pose(pose, Changed("design", base_stiffness=base))
        return there, design_plant(there, sensing)

    def tried(scale: float, base: float, weight: float, stage: Stage) -> Trial | None:
        there, plant = model(base)
        lag = slow_gain(stage.ratio, stage.turn / stage.ratio, sensing.step)
        shape = task_shape(there, gains, scale, weight, lag)
        try:
            central, b_opt = coprime_controller(shape.around(plant), FACTOR)
        except np.linalg.LinAlgError:
            return None
        notes = {
            "b_opt": b_opt,
            "scale": scale,
            "joint_weight": weight,
            "base_stiffness_factor": base,
            "ratio": stage.ratio,
            "turn_rad_s": stage.turn,
        }
        return Trial(SampledController("robust", pose, sensing, shape.unfold(central), None, notes), robots)

    for stage in stages:
        for base, weight in stage.shapes:
            attempt = partial(tried, base=base, weight=weight, stage=stage)

            found += stiffest(attempt, margin, halvings=HALVINGS, softest=reached)
            reached = max([reached, *(one.stiffness for one in found if one.seems_accepted(margin))])
        if reached >= soft:
            break
    return best_of(found, margin, pose).controller
