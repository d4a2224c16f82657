"""Many runs of the built-in plant under held torques: machine code in lanes, or NumPy rows without the extra."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache, partial

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.task import Target, tool_error
from flexbase.errors import InputError, MissingExtra
from flexbase.model.digest import model_digest
from flexbase.model.mounted import MountedArm
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose
from flexbase.simulation.plants.held import Function, Held
from flexbase.simulation.plants.physics import Seen
from flexbase.trace.kernel import kernel_of

FINEST = 2.5e-4  # s: longest step of the integrator
TURN = 0.05  # rad of the fastest vibration, a step: an error of 3e-9 of its amplitude [H93 II.1]
LAG_SHARE = 0.25  # of the accelerometers' lag, a step
MOST_STEPS = 1000  # between two samples
Rows = Callable[[Array], Array]  # (values, runs) to (values, runs)


class BuiltinHeld:
    """Runs of one arm, each with a goal pose of its own. Implements `Physics`."""

    def __init__(self, goals: Sequence[Pose], start: Array, sensing: Sensing) -> None:
        arm = goals[0].arm
        self._task = arm.task
        self._target = Target(*(np.stack(part) for part in zip(*(goal.target for goal in goals), strict=True)))
        self._rest = np.stack([goal.equilibrium for goal in goals]).T
        self._q, self._rates = start.T.copy(), np.zeros((arm.N, len(goals)))
        self._lagged = np.zeros((arm.n, len(goals)))
        self._parts = arm.parts
        self._steps = max(steps_between(goal, sensing) for goal in goals)
        self._time = np.full(len(goals), sensing.step / self._steps)
        self._pace = np.full(len(goals), pace_of(sensing))
        self._look, self._step = functions_of(arm)

    def observe(self, torque: Array, tip_force: Array) -> Seen:
        """See `Physics`."""
        found = self._look(np.vstack([self._q, self._rates, self._rest, torque.T, tip_force.T]))
        position, rotation = found[:3].T, found[3:12].T.reshape(-1, 3, 3)
        error = tool_error(position, rotation, self._task, self._target)
        speeds = self._parts.arm(self._rates.T).T
        acceleration = found[12:] if not self._pace[0] else (speeds - self._lagged) * self._pace
        return Seen(self._q.T.copy(), self._rates.T.copy(), error, acceleration.T.copy())

    def advance(self, torque: Array, tip_force: Array, alive: Array) -> None:
        """See `Physics`."""
        held = np.vstack([self._rest, torque.T, tip_force.T])
        N = len(self._q)
        for _ in range(self._steps):
            found = self._step(np.vstack([self._q, self._rates, held, self._lagged, self._time, self._pace]))
            self._q, self._rates, self._lagged = found[:N], found[N : 2 * N], found[2 * N :]


def pace_of(sensing: Sensing) -> float:
    """1/T of the accelerometers, 0 where they do not lag (or are not there)."""
    if sensing.acceleration != "accelerometer" or sensing.accelerometer_lag == 0.0:
        return 0.0
    return 1.0 / sensing.accelerometer_lag


def steps_between(goal: Pose, sensing: Sensing) -> int:
    """Steps of the integrator in a sample: short against the fastest free vibration and the accelerometers' lag.

    Raises InputError where that is more than `MOST_STEPS`.
    """
    fastest = float(np.sqrt(np.abs(np.linalg.eigvals(np.linalg.solve(goal.M, goal.K))).max()))
    longest = [FINEST, TURN / fastest if fastest else FINEST]
    pace = pace_of(sensing)
    steps = int(np.ceil(sensing.step / min(*longest, LAG_SHARE / pace if pace else FINEST) - 1e-9))
    if steps > MOST_STEPS:
        raise InputError(
            f"simulate: a sample of {sensing.step:g} s takes {steps} steps of the integrator, {MOST_STEPS} at most, "
            f"because of a vibration of {fastest:.4g} rad/s or a lag of {sensing.accelerometer_lag:g} s. "
            "Raise the rate, or leave the lag out (0)."
        )
    return steps


@lru_cache(maxsize=32)
def functions_of(arm: MountedArm) -> tuple[Rows, Rows]:
    """`look` and `step` of an arm, from and to arrays of shape (values, runs)."""
    held, about = Held(arm), f"{model_digest(arm)} gravity {arm.gravity.tolist()}"
    inputs = sum(held.sizes)
    try:
        return (
            kernel_of(held.look, inputs, f"held look\n{about}"),
            kernel_of(held.step, inputs + arm.n + 2, f"held step\n{about}"),
        )
    except MissingExtra:
        return partial(_rows, held.look), partial(_rows, held.step)


def _rows(function: Function, inputs: Array) -> Array:
    return np.stack(np.broadcast_arrays(*function(tuple(inputs))))
