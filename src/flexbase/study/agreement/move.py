"""The verdict as it will be met: a move, a push, counts, noise and limits, on the changed robot, in MuJoCo."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import Any

import numpy as np

from flexbase.model.sensing import Sensing
from flexbase.simulation import Push, SampledMove, SampledRun, simulate_sampled
from flexbase.study.agreement import nudge as agreement_nudge
from flexbase.study.agreement.case import Case, Outcome

COUNTS = (2.0**17, 2.0**20, 2.0**23)  # a turn, or a metre
TIP_NOISES = (0.0, 1e-6, 1e-5)  # m or rad
ACCELERATION_NOISES = (0.0, 0.1, 1.0)  # rad/s^2 or m/s^2
SATURATED = 5e-3  # m or rad: the tip error at which the task stiffness alone asks for all that a drive has
LEAST = 5.0  # rad/s^2 or m/s^2 of a joint by itself: a drive gives no less, also where it does not move the tip
SLEW = 200.0  # 1/s: from nothing to the limit in 5 ms
APART = 0.3  # rad or m by which every joint is off at the start, at most
SWITCH, PUSH, END = 0.5, 0.9, 5.0  # s: controller takes over; push begins; last sample
FORCE, LENGTH = 20.0, 0.05  # N or N m, s
AT_REST = 5e-4  # m or rad: error of a loop at rest, with all its noise


def prepared(case: Case, seed: int) -> Case:
    """The case with counts, noises and limits drawn for it; controller and verdict stay."""
    rng = np.random.default_rng([seed, case.number, 3])
    controller, arm = case.controller, case.pose.arm
    gains = arm.gains
    assert gains is not None  # checked by the study
    stiffness = case.scale * gains.stiffness
    pull = SATURATED * np.abs(controller.pose.Jv.T @ stiffness).sum(axis=1)
    limits = np.maximum(pull, LEAST * np.diag(controller.pose.Mhat))
    sensing = replace(
        controller.sensing,
        encoder_counts=float(rng.choice(COUNTS)),
        task_noise=float(rng.choice(TIP_NOISES)),
        acceleration_noise=float(rng.choice(ACCELERATION_NOISES)),
        torque_limit=tuple(limits.tolist()),
        torque_slew=tuple((SLEW * limits).tolist()),
    )
    return _sensed(case, sensing)


def watch(case: Case) -> Outcome:
    """Drive from up to 0.3 rad off in every joint, hand over to the controller, push it once, and watch it for 4 s.

    The linear verdict is not looked at. Settled: in the last second the tip error stays below 0.5 mm and is not half as
    large again as in the second before.
    """
    run = drive(case)
    seen = "diverged" if run.diverged else "at rest" if run.settled else "away"
    return Outcome(run.settled, seen, float(run.t[-1]), float("nan"))


def drive(case: Case) -> SampledRun:
    """The run that `watch` judges."""
    arm = case.pose.arm
    rng = np.random.default_rng([case.number, 5])
    joints = case.controller.pose.joints
    force = rng.standard_normal(arm.k)
    return simulate_sampled(
        case.controller,
        joints + rng.uniform(-APART, APART, arm.n),
        pose=case.pose,
        push=Push(tuple((FORCE / np.linalg.norm(force) * force).tolist()), PUSH, LENGTH),
        move=SampledMove(switch=SWITCH, end=END, engine="mujoco", tolerance=AT_REST, seed=case.number),
    )


def explain(case: Case) -> dict[str, Any]:
    """What takes a verdict away: found by leaving out the limits, then the noise, then all but a nudge."""
    sensing = case.controller.sensing
    free = replace(sensing, torque_limit=None, torque_slew=None)
    quiet = replace(free, encoder_counts=None, task_noise=0.0, acceleration_noise=0.0)
    nudged = agreement_nudge.watch(_sensed(case, quiet))
    known = {"time_constant_s": 1.0 / max(abs(case.rate), 1e-12), "watched_again": asdict(nudged)}
    if nudged.settled != case.stable:
        return {**agreement_nudge.explain(_sensed(case, quiet)), "nudged": asdict(nudged)}
    for cause, without in (("the limits of the drives", free), ("noise and counts", quiet)):
        if watch(_sensed(case, without)).settled == case.stable:
            return {"why": f"true of a nudge; {cause} make the difference", **known}
    return {"why": "true of a nudge; the size of the motion makes the difference", **known}


def _sensed(case: Case, sensing: Sensing) -> Case:
    return replace(case, controller=replace(case.controller, sensing=sensing))
