"""Move by joint tracking, then settle by task-space control, on the nonlinear plant.  [U03 §IV B]"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import DOP853

from flexbase.checks import Array, choose
from flexbase.control.joint_tracking import BANDWIDTH, JointTracking
from flexbase.control.measured import Measured
from flexbase.control.null_space import Law, Sum, null_space_damping
from flexbase.control.task_pd import TaskPD
from flexbase.control.trajectories import LAWS, JointPath
from flexbase.dynamics.kinematics import Frames, forward, task_jacobian
from flexbase.dynamics.task import task_error
from flexbase.errors import FlexbaseWarning, Infeasible, InputError
from flexbase.linear.linearise import check_definite_inertia
from flexbase.linear.margins import closed_loop_abscissa
from flexbase.model.loop import HasGain, Loop, loop_on
from flexbase.model.task import Gains
from flexbase.plant import Plant, Pose, check_plant
from flexbase.simulation.plants.builtin import keeps_inertia
from flexbase.simulation.plants.engines import ENGINES, Accelerations
from flexbase.simulation.result import Run
from flexbase.trace.algebra import matvec, stack, unstack

RELATIVE, ABSOLUTE = 1e-8, 1e-10  # of the integrator, a step
FASTEST = 1e3  # rad/s or m/s of a joint: beyond, the motion has diverged
LARGEST = 1_000_000  # samples of a run
MOST_STEPS = 10_000  # of the integrator in a phase; the paper's run takes some 200
SELF_MOTION = 20.0  # rad/s of a redundant arm's self-motion: below the base, so that it hardly drives it
WHEN = ("settle", "always")


def simulate(
    plant: Plant,
    start: Pose | ArrayLike,
    goal: Pose | ArrayLike,
    compensator: HasGain | None = None,
    *,
    gains: Gains | None = None,
    switch: float = 0.1,
    end: float = 0.4,
    trajectory: str = "quintic",
    compensate: str = "settle",
    bandwidth: float = BANDWIDTH,
    interval: float = 2e-4,
    self_motion: float = SELF_MOTION,
    engine: str = "builtin",
) -> Run:
    """Drive from rest at `start` to `goal`, each a pose or a tip target.

    Until `switch` [s] the joints follow a straight path in joint space by inverse dynamics of the rigid arm; from then
    to `end` the task-space PD loop with `gains` (the project's own if left out) settles the tip. The laws see the arm
    joints and the tip error, never the base. E q_a'' is solved implicitly with the accelerations.

    goal, start : of a tip target's several postures, the goal's is the nearest to the compensator's own, the start's
        the nearest to the goal's
    compensate : "settle", the compensator acts from `switch` on (it was designed for the goal); or "always"
    interval : between samples of the result [s]
    self_motion : of a redundant arm: natural frequency that its null-space damping gives it [rad/s], 0 for none
    engine : the physics that answers the laws: "builtin", or "mujoco" as an independent witness
    Raises InputError, MissingExtra. A motion that diverges, or leaves M - E > 0, ends early; `Run.stopped` says so.
    """
    check_plant(plant)
    m = plant.arm.m
    loop = loop_on(plant.arm, Loop(compensator, gains))
    gains, E = loop.gains, loop.E
    there = goal if isinstance(goal, Pose) else plant.at_tip(goal, near=loop.designed_at)
    here = start if isinstance(start, Pose) else plant.at_tip(start, near=there.q[m:])
    if not here.plant.name == there.plant.name == plant.name:
        raise InputError("simulate: the poses belong to another plant. Make them with this plant's at or at_tip.")
    if not 0.0 < switch < end < np.inf:
        raise InputError(f"times: switch ({switch:g} s) must lie above 0 and below end ({end:g} s). Give such times.")
    if not end / LARGEST <= interval <= end - switch:
        raise InputError(f"times: interval ({interval:g} s) must lie from {end / LARGEST:g} to {end - switch:g} s.")
    if compensate not in WHEN:
        raise InputError(f'compensate: "{compensate}" is unknown. Give one of {", ".join(WHEN)}.')
    if not bandwidth > 0.0:
        raise InputError(f"bandwidth: {bandwidth:g} rad/s must be above 0.")
    if E is not None:
        check_definite_inertia(there, E)
    physics = choose("engine", engine, ENGINES)(there)
    path = JointPath(here.q[m:].tolist(), there.q[m:].tolist(), switch, choose("trajectory", trajectory, LAWS))
    phases: list[tuple[Law, float, float, Array | None]] = [
        (JointTracking(there, path, bandwidth), 0.0, switch, E if compensate == "always" else None),
        (settling_law(there, gains, compensator, self_motion), switch, end, E),
    ]
    state, parts, stopped = np.concatenate([here.q, np.zeros(plant.arm.N)]), [], None
    for law, begin, finish, gain in phases:
        times, states, stopped = _integrate(there, physics, law, gain, begin, finish, interval, state)
        parts.append((times, states, _torques(there, physics, law, gain, times, states)))
        if stopped:
            break
        state = states[-1]
    times, states, torques = (np.concatenate(pieces) for pieces in zip(*_without_doubled_ends(parts), strict=True))
    N = plant.arm.N
    pole = closed_loop_abscissa(there, np.zeros((plant.arm.n,) * 2) if E is None else E, gains)
    error = task_error(forward(plant.arm.mechanism, tuple(states[:, :N].T)), plant.arm.task, there.target)
    return Run(
        here, there, times, states[:, :N], states[:, N:], error, torques, switch, E is not None, pole, stopped, engine
    )


def settling_law(goal: Pose, gains: Gains, compensator: HasGain | None, self_motion: float) -> Law:
    """Task PD, and for a redundant arm the damping of its self-motion.  [theory §7]"""
    task = TaskPD(goal, gains)
    if goal.arm.n <= goal.arm.k or self_motion == 0.0:
        return task
    try:
        return Sum(task, null_space_damping(goal, compensator, frequency=self_motion))
    except Infeasible as fault:
        warnings.warn(f"{fault} The consistent kind is used, without that promise.", FlexbaseWarning, stacklevel=3)
        return Sum(task, null_space_damping(goal, compensator, frequency=self_motion, kind="consistent"))


def _integrate(
    goal: Pose,
    physics: Accelerations,
    law: Law,
    E: Array | None,
    begin: float,
    finish: float,
    interval: float,
    state: Array,
) -> tuple[Array, Array, str | None]:
    """One phase: sample times from begin to finish, states there, and why it ended early."""
    times = np.linspace(begin, finish, round((finish - begin) / interval) + 1)
    states, taken = np.empty((len(times), len(state))), 1
    states[0] = state
    solver = DOP853(lambda t, x: _rate(goal, physics, law, E, t, x), begin, state, finish, rtol=RELATIVE, atol=ABSOLUTE)
    steps = 0
    while (trouble := _trouble(goal, E, solver, steps)) is None and solver.status == "running":
        solver.step()
        steps += 1
        reached = int(np.searchsorted(times, solver.t, side="right"))
        if reached > taken and solver.status != "failed":
            states[taken:reached] = solver.dense_output()(times[taken:reached]).T
            taken = reached
    if trouble is not None:
        return times[:taken], states[:taken], f"{trouble} at {solver.t:.4f} s"
    states[-1] = solver.y
    return times, states, None


def _trouble(goal: Pose, E: Array | None, solver: DOP853, steps: int) -> str | None:
    """Why the run cannot go on, or None."""
    q = solver.y[: goal.arm.N]
    if solver.status == "failed":
        return "the integrator gave up"
    if steps > MOST_STEPS:
        return f"the loop is too fast to follow ({MOST_STEPS} steps; lower the gains of light joints)"
    if not np.all(np.isfinite(solver.y)) or float(np.abs(solver.y[goal.arm.N :]).max()) > FASTEST:
        return "the motion diverged"
    if not keeps_inertia(goal.arm, forward(goal.arm.mechanism, unstack(q, 1)), E):
        return "M - E was no longer positive definite"
    return None


def _rate(goal: Pose, physics: Accelerations, law: Law, E: Array | None, time: float, state: Array) -> Array:
    N = goal.arm.N
    q, rates = state[:N], state[N:]
    frames, seen = _observe(goal, time, q, rates)
    return np.concatenate([rates, physics(frames, q, rates, stack(law.torque(seen)), E)])


def _observe(goal: Pose, time: float | Array, q: Array, rates: Array) -> tuple[Frames, Measured]:
    """Where the bodies truly are, and the part of it that a controller may see; one instant or a batch."""
    arm = goal.arm
    joints, speeds = unstack(q, 1), unstack(rates, 1)
    frames = forward(arm.mechanism, joints)
    tip_rate = matvec(task_jacobian(frames, arm.task.indices), speeds)
    tip_error = unstack(task_error(frames, arm.task, goal.target), 1)
    return frames, Measured(time, joints[arm.m :], speeds[arm.m :], tip_error, tip_rate)


def _torques(goal: Pose, physics: Accelerations, law: Law, E: Array | None, times: Array, states: Array) -> Array:
    """All that the drives deliver at each sample: the law's torque and E q_a''."""
    N, m = goal.arm.N, goal.arm.m
    q, rates = states[:, :N], states[:, N:]
    frames, seen = _observe(goal, times, q, rates)
    torque = stack(law.torque(seen))
    if E is None:
        return np.asarray(torque)
    return np.asarray(torque + physics(frames, q, rates, torque, E)[:, m:] @ E)


def _without_doubled_ends(parts: Sequence[tuple[Array, ...]]) -> list[tuple[Array, ...]]:
    """The first phase without its last sample, which is the second's first."""
    return [tuple(array[:-1] for array in part) for part in parts[:-1]] + [parts[-1]]
