"""A sampled controller on a nonlinear plant, as hardware would run it: the proof of a linear verdict.  [theory §10]"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from numpy.typing import ArrayLike

from flexbase.cautions import collected
from flexbase.checks import Array, check_length
from flexbase.errors import InputError
from flexbase.plant import Pose, check_pose
from flexbase.sampled.controller import SampledController
from flexbase.simulation.ends import check_same_joints
from flexbase.simulation.hardware.push import Push
from flexbase.simulation.hardware.result import SampledRun
from flexbase.simulation.hardware.side_by_side import Case, alike, side_by_side
from flexbase.simulation.move import SampledMove


def simulate_sampled(
    controller: SampledController,
    start: Pose | ArrayLike | None = None,
    *,
    pose: Pose | None = None,
    push: Push | None = None,
    move: SampledMove = SampledMove(),
) -> SampledRun:
    """Run a sampled controller on the nonlinear plant with all that its sensing declares.

    Torques are held between samples and `compute_delay` late; the tip error comes once in `task_every` samples,
    `task_delay` late, with noise; joints come in encoder counts; accelerations through the accelerometers' lag, with
    noise; drives saturate. Between samples the plant moves as it is, by Runge-Kutta steps of at most 0.25 ms, or by
    MuJoCo's own integrator.

    start : a pose, n arm joints, or None for the goal; at rest. It drives from there by joint tracking until
        `move.switch`, a straight path in joint space; with 0 the controller takes over at once and brings the tip in
    pose : where it really runs, also of a robot that differs from the controller's (`changed_pose`); the controller's
        own if left out. Its resting tip is the goal. Gravity is held by the controller's model of the robot
    push : a force on the tool; move : times, path, physics ("builtin", or "mujoco" as an independent witness), noise
    Raises InputError, MissingExtra. A run that diverges ends early; `SampledRun.stopped` says so.
    """
    return simulate_sampled_many(
        [controller],
        None if start is None else [start],
        poses=None if pose is None else [pose],
        push=push,
        move=move,
    )[0]


def simulate_sampled_many(
    controllers: Sequence[SampledController],
    starts: Sequence[Pose | ArrayLike] | None = None,
    *,
    poses: Sequence[Pose] | None = None,
    push: Push | None = None,
    move: SampledMove = SampledMove(),
) -> tuple[SampledRun, ...]:
    """`simulate_sampled` for many controllers: those that share robot and sensing run side by side."""
    SampledMove.checked(move)
    if push is not None and not isinstance(push, Push):
        raise InputError(f"push: {type(push).__name__} given. Give a Push(force, start, duration).")
    cases = _cases(controllers, starts, poses)
    found: dict[int, SampledRun] = {}
    with collected() as said:
        for members in alike(cases):
            runs = side_by_side([cases[i] for i in members], push, move)
            found.update(zip(members, runs, strict=True))
    return tuple(replace(found[i], cautions=tuple(said)) for i in range(len(cases)))


def _cases(
    controllers: Sequence[SampledController],
    starts: Sequence[Pose | ArrayLike] | None,
    poses: Sequence[Pose] | None,
) -> list[Case]:
    """Every run's controller, goal and start, checked."""
    for one in controllers:
        if not isinstance(one, SampledController):
            raise InputError(f"controller: {type(one).__name__} given. Give a SampledController.")
    goals = [one.pose for one in controllers] if poses is None else list(poses)
    here = goals if starts is None else list(starts)
    if not len(controllers) == len(goals) == len(here):
        raise InputError(
            f"simulate: {len(controllers)} controllers, {len(goals)} poses and {len(here)} starts. "
            "Give as many of each."
        )
    for one, goal in zip(controllers, goals, strict=True):
        check_pose(goal)
        check_same_joints(one.pose.plant, goal)
    return [Case(one, goal, _start(at, goal)) for one, goal, at in zip(controllers, goals, here, strict=True)]


def _start(start: Pose | ArrayLike, goal: Pose) -> Array:
    """All joints at the start; the base rests where it does with the goal's robot."""
    if isinstance(start, Pose):
        check_same_joints(goal.plant, start)
        return start.q
    joints = check_length("start", start, goal.arm.n, "one for each arm joint")
    return goal.plant.at(goal.arm.parts.whole(goal.equilibrium, joints)).q
