"""Baseline: task PD and viscous damping of the joints.  [U03 ref 12]"""

from __future__ import annotations

import numpy as np

from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.sampled.controller import SampledController, pd_with_gain
from flexbase.sampled.judged import GOOD_MARGIN, Judged, robots_at
from flexbase.synthesis.registry import hardware_method
from flexbase.synthesis.search.stiffest import best_of

RATES = np.concatenate([[0.0], np.geomspace(3.0, 1000.0, 11)])  # damping over each joint's own inertia [1/s]


@hardware_method("viscous", "task PD and damped joints: simple, and what is tried first")
def viscous(pose: Pose, sensing: Sensing, gains: Gains) -> SampledController:
    """The task PD of `gains` and a damping of d times the diagonal of Mhat, with the d that does best at this pose."""
    robots = robots_at(pose, sensing)
    inertia = np.diag(np.diag(pose.Mhat))
    tried = []
    for rate in RATES:
        made = pd_with_gain(pose, sensing, gains, None, "viscous", rate * inertia)
        made.notes["damping_per_inertia"] = float(rate)
        tried.append(Judged(made, robots))
    return best_of(tried, GOOD_MARGIN, pose)
