"""Move by joint tracking, then settle by task-space control, on the nonlinear plant.  [U03 §IV B]"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from flexbase.cautions import collected
from flexbase.checks import Array
from flexbase.dynamics.kinematics import forward
from flexbase.dynamics.task import task_error
from flexbase.linear.linearise import check_definite_inertia
from flexbase.linear.margins import closed_loop_abscissa
from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Plant, Pose, check_plant
from flexbase.simulation.ends import end_on
from flexbase.simulation.laws import moving_law, settling_law
from flexbase.simulation.move import Move
from flexbase.simulation.plants.engines import ENGINES
from flexbase.simulation.result import Run
from flexbase.simulation.stage import Samples, Stage


def simulate(
    plant: Plant, start: Pose | ArrayLike, goal: Pose | ArrayLike, loop: Asked = None, *, move: Move = Move()
) -> Run:
    """Drive from rest at `start` to `goal`, each a pose or a tip target.

    Until `move.switch` the joints follow a straight path in joint space by inverse dynamics of the rigid arm; from then
    to `move.end` the task-space PD loop settles the tip. The laws see the arm joints and the tip error, never the base.
    E q_a'' is solved implicitly with the accelerations. Of the loop, its sensing is left out: continuous time.

    goal, start : of a tip target's several postures, the goal's is the nearest to the compensator's own, the start's
        the nearest to the goal's
    move : times, laws, and the physics that answers them: "builtin", or "mujoco" as an independent witness
    Raises InputError, MissingExtra. A motion that diverges, or leaves M - E > 0, ends early; `Run.stopped` says so.
    """
    check_plant(plant)
    Move.checked(move)
    with collected() as said:
        spec = loop_on(plant.arm, loop)
        there = end_on(plant, goal, spec.designed_at)
        here = end_on(plant, start, there.joints)
        check_definite_inertia(there, spec.gain)
        physics = ENGINES[move.engine].accelerations(there)
        tracking = moving_law(there, here.joints.tolist(), move.switch, move)
        first = spec.E if move.compensate == "always" else None
        stages = (
            Stage(there, physics, tracking, first, 0.0, move.switch),
            Stage(there, physics, settling_law(there, spec, move), spec.E, move.switch, move.end),
        )
        samples, stopped = _one_after_the_other(stages, np.concatenate([here.q, np.zeros(plant.arm.N)]), move.interval)
        pole = closed_loop_abscissa(there, spec.gain, spec.gains)
    q, rates = np.split(samples.states, 2, axis=1)
    error = task_error(forward(plant.arm.mechanism, tuple(q.T)), plant.arm.task, there.target)
    return Run(
        there, samples.times, q, rates, error, samples.torque, move.switch, here, spec.E is not None, pole, move.engine,
        stopped=stopped, cautions=tuple(said),
    )  # fmt: skip


def _one_after_the_other(stages: tuple[Stage, ...], state: Array, interval: float) -> tuple[Samples, str | None]:
    """Each stage begins where the one before ended; the sample that both have is the later one's."""
    parts: list[Samples] = []
    stopped = None
    for stage in stages:
        if stopped is None:
            part, stopped = stage.run(state, interval)
            parts = [*parts[:-1], *(Samples(*(array[:-1] for array in before)) for before in parts[-1:]), part]
            state = part.states[-1]
    return Samples(*(np.concatenate(pieces) for pieces in zip(*parts, strict=True))), stopped
