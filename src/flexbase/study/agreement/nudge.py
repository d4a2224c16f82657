"""The verdict by itself: a nudge too small for anything but the linear loop to matter, watched in MuJoCo."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from flexbase.checks import Array
from flexbase.simulation.hardware.loops import SampledLoops
from flexbase.simulation.plants.mujoco_held import MujocoHeld
from flexbase.study.agreement.case import Case, Outcome

NUDGE = 1e-6  # rad or m of all joints together: the start
GROWN = 1e3  # times the nudge: has left
DECAYED = 1e-4  # of the largest deviation so far: has come to rest, if it stays so for as long again
WINDOW = 0.05  # s, over which the largest deviation is taken
LONGEST = 8.0  # s: after it, the last quarter is compared with the one before
NEAR = 1e-3  # of 1: spectral radii that count as borderline


def watch(case: Case, nudge: float = NUDGE, longest: float = LONGEST) -> Outcome:
    """Nudge all joints, base and arm, at rest in MuJoCo, and wait until the motion has grown or died out.

    The linear verdict is not looked at: neither the horizon nor the rule depends on it. Grown: a thousand times the
    nudge. Died out: below 1e-4 of the largest deviation, and still so after as long again. Neither within `longest`
    seconds: the larger of the last quarter and the one before it decides.
    """
    sensing, goal = case.controller.sensing, case.pose
    direction = np.random.default_rng([case.number, 7]).standard_normal(goal.arm.N)
    start = (goal.q + nudge * direction / np.linalg.norm(direction))[None]
    loop = SampledLoops([case.controller], [goal], MujocoHeld([goal], start, sensing), start=start)
    samples = max(16, round(WINDOW * sensing.rate))
    still = np.zeros((samples, goal.arm.k))
    sizes: list[float] = []
    rested: int | None = None  # number of the first window at rest
    while len(sizes) * samples * sensing.step < longest:
        sizes.append(float(np.linalg.norm(loop.go(still).q[:, 0] - goal.q, axis=1).max()))
        if not loop.alive[0] or not sizes[-1] <= GROWN * nudge:
            return _outcome(False, "grown", sizes, samples * sensing.step)
        if sizes[-1] >= DECAYED * max(sizes):
            rested = None
        elif rested is None:
            rested = len(sizes)
        elif len(sizes) >= 2 * rested:
            return _outcome(True, "decayed", sizes[:rested], samples * sensing.step)
    quarter = len(sizes) // 4
    settled = max(sizes[-quarter:]) < max(sizes[-2 * quarter : -quarter])
    return _outcome(settled, "slope", sizes, samples * sensing.step)


def _outcome(settled: bool, seen: str, sizes: list[float], window: float) -> Outcome:
    return Outcome(settled, seen, len(sizes) * window, growth_of(np.array(sizes), window))


def growth_of(sizes: Array, window: float) -> float:
    """Slope of the logarithm of the largest deviations, over their last half [1/s]; NaN of one window."""
    late = np.log(np.maximum(sizes[np.isfinite(sizes)], 1e-300))[-max(2, len(sizes) // 2) :]
    if len(late) < 2:
        return float("nan")
    return float(np.polyfit(window * np.arange(len(late)), late, 1)[0])


def explain(case: Case) -> dict[str, Any]:
    """Why a verdict did not come true: watched again from a hundredth of the nudge, four times as long."""
    again = watch(case, 0.01 * NUDGE, 4.0 * LONGEST)
    measured = float(np.exp(again.growth / case.controller.sensing.rate))
    said = f"spectral radius promised {case.radius:.7f}, measured {measured:.7f} a sample"
    if again.settled == case.stable:
        why = f"it comes true from a hundredth of the nudge, watched four times as long: {said}"
    elif max(abs(case.radius - 1.0), abs(measured - 1.0)) < NEAR:
        why = f"the border itself, within {NEAR:g} of 1: {said}"
    else:
        why = f"unexplained: {said}"
    return {"why": why, "time_constant_s": 1.0 / max(abs(case.rate), 1e-12), "watched_again": asdict(again)}
