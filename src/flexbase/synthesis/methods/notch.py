"""Baseline: task PD behind a notch at every base mode."""

from __future__ import annotations

import numpy as np

from flexbase.errors import Infeasible
from flexbase.linear.discrete.system import Discrete, series, side_by_side, static
from flexbase.linear.modal import modes
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.sampled.controller import SampledController, task_pd
from flexbase.sampled.judged import GOOD_MARGIN, Judged, robots_at
from flexbase.synthesis.registry import hardware_method
from flexbase.synthesis.search.stiffest import best_of

WIDTHS = (0.1, 0.2, 0.4, 0.7, 1.0, 1.5)  # damping ratio of the notch's poles
DEPTH = 0.1  # gain that is left at the mode's frequency


@hardware_method("notch", "task PD that does not answer at the base's frequencies")
def notch(pose: Pose, sensing: Sensing, gains: Gains) -> SampledController:
    """The task PD of `gains` on the tip error through a notch at every base mode below Nyquist's frequency.

    The notches share one width, the one that does best at this pose. Raises Infeasible where all modes are faster.
    """
    frequencies = [mode.frequency for mode in modes(pose).modes if 0.0 < mode.frequency < np.pi / sensing.step]
    if not frequencies:
        raise Infeasible(f"{pose.plant.name}: no base mode is below {np.pi / sensing.step:.4g} rad/s, half the rate.")
    robots, law = robots_at(pose, sensing), task_pd(pose, sensing, gains)
    k, n = pose.arm.k, pose.arm.n
    tried = []
    for width in WIDTHS:
        one = static(np.eye(1), sensing.step)
        for frequency in frequencies:
            one = series(one, notch_filter(frequency, width, sensing.step))
        seen = side_by_side(*[one] * k, static(np.eye(2 * n), sensing.step))
        notes = {"width": width, "frequencies_rad_s": frequencies}
        tried.append(Judged(SampledController("notch", pose, sensing, series(seen, law), None, notes), robots))
    return best_of(tried, GOOD_MARGIN, pose)


def notch_filter(frequency: float, width: float, step: float) -> Discrete:
    """(s^2 + 2 DEPTH width w s + w^2)/(s^2 + 2 width w s + w^2) by Tustin's rule, prewarped at w [rad/s]."""
    t = np.tan(0.5 * frequency * step)
    top = np.array([1.0 + 2.0 * DEPTH * width * t + t * t, 2.0 * (t * t - 1.0), 1.0 - 2.0 * DEPTH * width * t + t * t])
    low = np.array([1.0 + 2.0 * width * t + t * t, 2.0 * (t * t - 1.0), 1.0 - 2.0 * width * t + t * t])
    top, low = top / low[0], low / low[0]
    A = np.array([[-low[1], -low[2]], [1.0, 0.0]])
    return Discrete(A, np.array([[1.0], [0.0]]), (top[1:] - low[1:] * top[0])[None, :], top[:1, None], step)
