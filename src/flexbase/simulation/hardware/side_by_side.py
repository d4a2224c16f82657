"""Sampled runs that share robot and sensing, stepped together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from flexbase.checks import Array
from flexbase.control.joint_tracking import JointTracking
from flexbase.control.trajectories import LAWS, JointPath
from flexbase.errors import InputError
from flexbase.model.digest import model_digest
from flexbase.plant import Pose
from flexbase.sampled.closed import close_loop
from flexbase.sampled.controller import SampledController
from flexbase.simulation.hardware.laws import Tracking
from flexbase.simulation.hardware.loops import SampledLoops
from flexbase.simulation.hardware.push import Push
from flexbase.simulation.hardware.result import SampledRun
from flexbase.simulation.move import SampledMove
from flexbase.simulation.plants.engines import ENGINES

LARGEST = 2_000_000  # samples of a run


class Case(NamedTuple):
    """One run: its controller, where it really goes, and all joints at the start, shape (N,)."""

    controller: SampledController
    goal: Pose
    start: Array


def alike(cases: Sequence[Case]) -> list[list[int]]:
    """Numbers of the runs that go side by side: the same robot, the same sensing."""
    groups: dict[tuple[object, ...], list[int]] = {}
    for i, (one, goal, _) in enumerate(cases):
        key = (model_digest(goal.arm), tuple(goal.arm.gravity.tolist()), one.sensing)
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def side_by_side(cases: Sequence[Case], push: Push | None, move: SampledMove) -> list[SampledRun]:
    """Runs of one robot and one sensing. Raises InputError, MissingExtra."""
    controllers, goals = [case.controller for case in cases], [case.goal for case in cases]
    start, sensing, k = np.stack([case.start for case in cases]), controllers[0].sensing, goals[0].arm.k
    samples, tracked = round(move.end * sensing.rate), round(move.switch * sensing.rate)
    if not 16 <= samples <= LARGEST:
        raise InputError(
            f"times: {move.end:g} s at {sensing.rate:g} Hz is {samples} samples; 16 to {LARGEST} are run. "
            "Give another end."
        )
    forces = np.zeros((samples, k)) if push is None else push.forces(samples, sensing, k)
    physics = ENGINES[move.engine].held(goals, start, sensing)
    tracking = Tracking([_tracking(case, move) for case in cases], sensing.step, tracked) if tracked else None
    loops = SampledLoops(controllers, goals, physics, start=start, tracking=tracking, seed=move.seed)
    record = loops.go(forces)

    def run(place: int, case: Case) -> SampledRun:
        ended = int(loops.ended[place])
        kept = slice(0, ended if ended >= 0 else samples)
        return SampledRun(
            controller=case.controller,
            goal=case.goal,
            t=np.asarray(np.arange(samples)[kept] * sensing.step),
            q=record.q[kept, place],
            rates=record.rates[kept, place],
            tip_error=record.tip_error[kept, place],
            torque=record.torque[kept, place],
            switch=tracked * sensing.step,
            push=push,
            spectral_radius=close_loop(case.goal, case.controller).radius,
            saturated_samples=int(loops.saturated[place]),
            engine=move.engine,
            seed=move.seed,
            tolerance=move.tolerance,
            stopped=None if ended < 0 else f"the motion diverged at {ended * sensing.step:.4f} s",
        )

    return [run(place, case) for place, case in enumerate(cases)]


def _tracking(case: Case, move: SampledMove) -> JointTracking:
    """By the controller's model of the robot, to where the goal's robot rests."""
    start = case.goal.arm.parts.arm(case.start)
    path = JointPath(start.tolist(), case.goal.joints.tolist(), move.switch, LAWS[move.trajectory])
    return JointTracking(case.controller.pose, path, move.bandwidth)
