"""A sampled controller on a nonlinear plant, as hardware would run it: the proof of a linear verdict.  [theory §10]"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from flexbase.checks import Array, check_length, choose
from flexbase.control.joint_tracking import JointTracking
from flexbase.control.trajectories import LAWS, JointPath, Law
from flexbase.errors import InputError
from flexbase.model.digest import model_digest
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose
from flexbase.sampled.closed import close_loop
from flexbase.sampled.controller import SampledController
from flexbase.simulation.hardware.loop import Loop
from flexbase.simulation.hardware.result import Push, SampledRun
from flexbase.simulation.laws import Tracking
from flexbase.simulation.plants.builtin_held import BuiltinHeld
from flexbase.simulation.plants.mujoco_held import MujocoHeld
from flexbase.simulation.plants.physics import Physics
from flexbase.simulation.result import SETTLED

HELD_ENGINES: dict[str, Callable[[Sequence[Pose], Array, Sensing], Physics]] = {
    "builtin": BuiltinHeld,
    "mujoco": MujocoHeld,
}
LARGEST = 2_000_000  # samples of a run
BANDWIDTH = 20.0  # rad/s of joint tracking: 40 is unstable at 1 kHz in the start pose of the paper's move


def simulate_sampled(
    controller: SampledController,
    start: Pose | ArrayLike | None = None,
    *,
    pose: Pose | None = None,
    switch: float = 0.0,
    end: float = 0.5,
    push: Push | None = None,
    engine: str = "builtin",
    trajectory: str = "quintic",
    bandwidth: float = BANDWIDTH,
    tolerance: float = SETTLED,
    seed: int = 0,
) -> SampledRun:
    """Run a sampled controller on the nonlinear plant with all that its sensing declares.

    Torques are held between samples and `compute_delay` late; the tip error comes once in `task_every` samples,
    `task_delay` late, with noise; joints come in encoder counts; accelerations through the accelerometers' lag, with
    noise; drives saturate. Between samples the plant moves as it is, by Runge-Kutta steps of at most 0.25 ms, or by
    MuJoCo's own integrator.

    start : a pose, n arm joints, or None for the goal; at rest. It drives from there by joint tracking until `switch`
        [s], a straight path in joint space; with 0 the controller takes over at once, and must bring the tip in
    pose : where it really runs, also of a robot that differs from the controller's (`changed_pose`); the controller's
        own if left out. Its resting tip is the goal. Gravity is held by the controller's model of the robot
    push : a force on the tool; engine : "builtin", or "mujoco" as an independent witness
    tolerance : tip error that counts as settled [m, and rad for rotation rows]; seed : of all noise
    Raises InputError, MissingExtra. A run that diverges ends early; `SampledRun.stopped` says so.
    """
    return simulate_sampled_many(
        [controller],
        None if start is None else [start],
        poses=None if pose is None else [pose],
        switch=switch,
        end=end,
        push=push,
        engine=engine,
        trajectory=trajectory,
        bandwidth=bandwidth,
        tolerance=tolerance,
        seed=seed,
    )[0]


def simulate_sampled_many(
    controllers: Sequence[SampledController],
    starts: Sequence[Pose | ArrayLike] | None = None,
    *,
    poses: Sequence[Pose] | None = None,
    switch: float = 0.0,
    end: float = 0.5,
    push: Push | None = None,
    engine: str = "builtin",
    trajectory: str = "quintic",
    bandwidth: float = BANDWIDTH,
    tolerance: float = SETTLED,
    seed: int = 0,
) -> tuple[SampledRun, ...]:
    """`simulate_sampled` for many controllers: those that share robot and sensing run side by side."""
    goals = [one.pose for one in controllers] if poses is None else list(poses)
    here = goals if starts is None else list(starts)
    if not len(controllers) == len(goals) == len(here):
        raise InputError(
            f"simulate: {len(controllers)} controllers, {len(goals)} poses and {len(here)} starts. "
            "Give as many of each."
        )
    make = choose("engine", engine, HELD_ENGINES)
    law = choose("trajectory", trajectory, LAWS)
    begins = np.array([_start(one, goal) for one, goal in zip(here, goals, strict=True)])
    _check_times(switch, end)
    found: dict[int, SampledRun] = {}
    for members in _alike(controllers, goals):
        mine = [controllers[i] for i in members]
        there = [goals[i] for i in members]
        sensing, arm = mine[0].sensing, there[0].arm
        samples, tracked = _count(end, sensing), round(switch * sensing.rate)
        laws = [
            JointTracking(
                one.pose, JointPath(begins[i][arm.m :].tolist(), goal.q[arm.m :].tolist(), switch, law), bandwidth
            )
            for i, one, goal in zip(members, mine, there, strict=True)
        ]
        loop = Loop(
            mine,
            there,
            make(there, begins[members], sensing),
            start=begins[members],
            tracking=Tracking(laws, sensing.step) if tracked else None,
            tracked=tracked,
            seed=seed,
        )
        record = loop.go(_forces(push, samples, sensing, arm.k))
        for place, (i, one, goal) in enumerate(zip(members, mine, there, strict=True)):
            ended = int(loop.ended[place])
            kept = slice(0, ended if ended >= 0 else samples)
            found[i] = SampledRun(
                controller=one,
                goal=goal,
                t=np.asarray(np.arange(samples)[kept] * sensing.step),
                q=record.q[kept, place],
                rates=record.rates[kept, place],
                tip_error=record.tip_error[kept, place],
                torque=record.torque[kept, place],
                switch=tracked * sensing.step,
                push=push,
                spectral_radius=close_loop(goal, one).radius,
                saturated_samples=int(loop.saturated[place]),
                engine=engine,
                seed=seed,
                tolerance=tolerance,
                stopped=None if ended < 0 else f"the motion diverged at {ended * sensing.step:.4f} s",
            )
    return tuple(found[i] for i in range(len(controllers)))


def _alike(controllers: Sequence[SampledController], goals: Sequence[Pose]) -> list[list[int]]:
    """Numbers of the runs that go side by side: the same robot, the same sensing."""
    groups: dict[tuple[object, ...], list[int]] = {}
    for i, (one, goal) in enumerate(zip(controllers, goals, strict=True)):
        if one.pose.arm.N != goal.arm.N or one.pose.arm.m != goal.arm.m:
            raise InputError(
                f"simulate: a controller for {one.pose.plant.name} cannot run on {goal.plant.name}: other joints. "
                "Give a pose of the same robot, or of one that differs in numbers only (changed_pose)."
            )
        key = (model_digest(goal.arm), tuple(goal.arm.gravity.tolist()), one.sensing)
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def _start(start: Pose | ArrayLike, goal: Pose) -> Array:
    """All joints at the start; the base rests where it does with the goal's robot."""
    if isinstance(start, Pose):
        return start.q
    arm = goal.arm
    joints = check_length("start", start, arm.n, "one for each arm joint")
    return goal.plant.at(np.concatenate([goal.equilibrium, joints])).q


def _path(begin: Array, goal: Pose, switch: float, law: Law) -> JointPath:
    m = goal.arm.m
    return JointPath(begin[m:].tolist(), goal.q[m:].tolist(), switch, law)


def _count(end: float, sensing: Sensing) -> int:
    samples = round(end * sensing.rate)
    if not 16 <= samples <= LARGEST:
        raise InputError(
            f"times: {end:g} s at {sensing.rate:g} Hz is {samples} samples; 16 to {LARGEST} are run. Give another end."
        )
    return samples


def _check_times(switch: float, end: float) -> None:
    if not 0.0 <= switch < end < np.inf:
        raise InputError(f"times: switch ({switch:g} s) must lie from 0 to below end ({end:g} s). Give such times.")


def _forces(push: Push | None, samples: int, sensing: Sensing, k: int) -> Array:
    """Tip force at every sample, shape (samples, k)."""
    forces = np.zeros((samples, k))
    if push is not None:
        force = check_length("push", push.force, k, "one for each task row")
        begin = round(push.start * sensing.rate)
        stop = begin + max(1, round(push.duration * sensing.rate))
        if not 0 <= begin < stop < samples or not push.duration > 0.0:
            raise InputError(
                f"push: from {push.start:g} s for {push.duration:g} s does not end within the run. Give other times."
            )
        forces[begin:stop] = force
    return forces
