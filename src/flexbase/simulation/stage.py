"""One stage of an ideal run: a law, and the adaptive integrator that follows it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.integrate import DOP853

from flexbase.checks import Array
from flexbase.control.null_space import Law
from flexbase.dynamics.kinematics import forward
from flexbase.plant import Pose
from flexbase.simulation.observed import observe
from flexbase.simulation.plants.builtin import keeps_inertia
from flexbase.simulation.plants.engines import Accelerations
from flexbase.simulation.settling import FASTEST
from flexbase.trace.algebra import stack, unstack

RELATIVE, ABSOLUTE = 1e-8, 1e-10  # of the integrator, a step
MOST_STEPS = 10_000  # of the integrator in a stage; the paper's run takes some 200
INDEFINITE = "M - E was no longer positive definite"


class Samples(NamedTuple):
    """Times (T,), joints and rates (T, 2N), and all that the drives deliver: the law's torque and E q_a'' (T, n)."""

    times: Array
    states: Array
    torque: Array


@dataclass(frozen=True, eq=False)
class Stage:
    """A law from `begin` to `finish` [s]; E : acts implicitly, shape (n, n), or None."""

    goal: Pose
    physics: Accelerations
    law: Law
    E: Array | None
    begin: float
    finish: float

    def run(self, state: Array, interval: float) -> tuple[Samples, str | None]:
        """Samples from begin to finish, and why they end early, or None."""
        times, states, stopped = self._integrate(state, interval)
        return Samples(times, states, self._torque(times, states)), stopped

    def _integrate(self, state: Array, interval: float) -> tuple[Array, Array, str | None]:
        times = np.linspace(self.begin, self.finish, round((self.finish - self.begin) / interval) + 1)
        states, taken = np.empty((len(times), len(state))), 1
        states[0] = state
        solver = DOP853(self._slope, self.begin, state, self.finish, rtol=RELATIVE, atol=ABSOLUTE)
        steps = 0
        while (trouble := self._trouble(solver, steps)) is None and solver.status == "running":
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

    def _trouble(self, solver: DOP853, steps: int) -> str | None:
        """Why the run cannot go on, or None."""
        arm = self.goal.arm
        if solver.status == "failed":
            return "the integrator gave up"
        if steps > MOST_STEPS:
            return f"the loop is too fast to follow ({MOST_STEPS} steps; lower the gains of light joints)"
        if not np.all(np.isfinite(solver.y)) or float(np.abs(solver.y[arm.N :]).max()) > FASTEST:
            return "the motion diverged"
        if not keeps_inertia(arm, forward(arm.mechanism, unstack(solver.y[: arm.N], 1)), self.E):
            return INDEFINITE
        return None

    def _slope(self, time: float, state: Array) -> Array:
        N = self.goal.arm.N
        q, rates = state[:N], state[N:]
        frames, seen = observe(self.goal, time, q, rates)
        return np.concatenate([rates, self.physics(frames, q, rates, stack(self.law.torque(seen)), self.E)])

    def _torque(self, times: Array, states: Array) -> Array:
        N, parts = self.goal.arm.N, self.goal.arm.parts
        q, rates = states[:, :N], states[:, N:]
        frames, seen = observe(self.goal, times, q, rates)
        torque = np.asarray(stack(self.law.torque(seen)))
        if self.E is None:
            return torque
        return np.asarray(torque + parts.arm(self.physics(frames, q, rates, torque, self.E)) @ self.E)
