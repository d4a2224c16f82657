"""Many moves and settlings at once: fixed steps in machine code, a run in every lane."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexbase.cautions import collected
from flexbase.checks import Array
from flexbase.control.trajectories import SMOOTH_PARTS
from flexbase.dynamics.kinematics import forward
from flexbase.dynamics.task import task_error
from flexbase.linear.linearise import check_definite_inertia
from flexbase.model.loop import Asked, LoopSpec, loop_on
from flexbase.plant import Plant, Pose, check_plant
from flexbase.simulation.ends import end_on
from flexbase.simulation.laws import settling_law
from flexbase.simulation.many.inputs import inputs, probes, rests
from flexbase.simulation.many.phase import Always, Phase, Tracking
from flexbase.simulation.many.result import DIVERGED, INDEFINITE, OK, Runs
from flexbase.simulation.many.step import Step
from flexbase.simulation.many.step_size import first_step, short_enough
from flexbase.simulation.move import Moves
from flexbase.simulation.settling import FASTEST, SETTLED, error_sizes


def simulate_many(
    plant: Plant,
    starts: Pose | ArrayLike,
    goal: Pose | ArrayLike,
    loop: Asked = None,
    *,
    vary: Mapping[str, ArrayLike] | None = None,
    move: Moves = Moves(),
) -> Runs:
    """The runs of `simulate` for many starts, or for robots that differ from the one that the laws know; see there.

    Runge-Kutta steps of fixed size, chosen so that halving them moves no joint by more than `move.tolerance` at the
    switch and at the end, judged in a few of the runs. No history is kept. Assumes that the tool is less than half a
    turn from the goal after switching; gravity's sag at the start is that of the nominal robot.

    starts : arm joints at rest, shape (runs, n), or (n,) or a pose for all
    vary : parameter -> values, shape (runs,): `stiffness`, `damping`, `payload`, `link_mass`, `link_com`, such as
        `stiffness.JOINT`, of the robot; `task_stiffness`, `task_damping`, `compensation` of the loop (factors)
    Raises InputError, MissingExtra. A run that diverges, or leaves M - E > 0, has a status that says so.
    """
    check_plant(plant)
    Moves.checked(move)
    with collected() as said:
        spec = loop_on(plant.arm, loop)
        there = end_on(plant, goal, spec.designed_at)
        check_definite_inertia(there, spec.gain)
        joints, varied = inputs(plant, starts, vary or {})
        phases = _phases(there, spec, tuple(varied), move)
        state, constants = _begin(plant, joints, phases[0]), np.vstack([joints.T, *varied.values()])

        def ends(which: NDArray[np.intp], longest: float) -> list[Array]:
            """States of some of the runs after each phase."""
            found = [state[:, which]]
            for phase in phases:
                found.append(phase.run(found[-1], constants[:, which], longest, move.threads))
            return found[1:]

        few = probes(varied, len(joints))

        def probe(step: float) -> Array:
            """Joints after each phase, NaN where they run away."""
            N, speed = plant.arm.N, 2 * plant.arm.N + 3
            return np.array([np.where(end[speed] <= FASTEST, end[:N], np.nan) for end in ends(few, step)])

        longest, error = short_enough(probe, first_step(there, spec), move.tolerance)
        found = ends(np.arange(len(joints)), longest)[-1]
    return _judged(
        there, joints, varied, found, (phases[0].length(longest)[1], phases[1].length(longest)[1]), error, move,
        tuple(said),
    )  # fmt: skip


def _phases(goal: Pose, loop: LoopSpec, varied: tuple[str, ...], move: Moves) -> tuple[Phase, Phase]:
    """The move and the settling."""
    gain = None if loop.E is None else loop.E.tolist()
    moving = Step(goal, Tracking(goal, move), gain if move.compensate == "always" else None, varied)
    settling = Step(goal, Always(settling_law(goal, loop, move)), gain, varied)
    return (
        Phase(moving, 0.0, move.switch, SMOOTH_PARTS[move.trajectory]),
        Phase(settling, move.switch, move.end),
    )


def _begin(plant: Plant, joints: Array, phase: Phase) -> Array:
    """All runs at rest, shape (state, runs); the least pivot so far is infinite."""
    at_rest = np.hstack([rests(plant, joints), joints])
    state = np.zeros((phase.step.state, len(joints)))
    state[: plant.arm.N], state[-1] = at_rest.T, np.inf
    return state


def _judged(
    goal: Pose,
    start: Array,
    varied: dict[str, Array],
    found: Array,
    steps: tuple[float, float],
    step_error: float,
    move: Moves,
    cautions: tuple[str, ...],
) -> Runs:
    """What the runs come to, from their states at the end."""
    arm = goal.arm
    q, rates = found[: arm.N].T, found[arm.N : 2 * arm.N].T
    tip_error = task_error(forward(arm.mechanism, tuple(q.T)), arm.task, goal.target)
    _, peak, outside, speed, pivot = found[2 * arm.N :]
    status = np.where(np.isfinite(found[: 2 * arm.N]).all(axis=0) & (speed <= FASTEST), OK, DIVERGED)
    status = np.where(pivot > 0.0, status, INDEFINITE).astype(np.int8)
    size = error_sizes(tip_error, arm.task)
    settled = (status == OK) & (size < SETTLED)
    return Runs(
        goal, start, varied, q, rates, tip_error,
        peak_error_m=np.where(status == OK, np.fmax(peak, size), np.nan),
        settling_time_s=np.where(settled, (outside + 1.0) * steps[1], np.nan),
        status=status, switch=move.switch, end=move.end, step=steps, step_error=step_error, cautions=cautions,
    )  # fmt: skip
