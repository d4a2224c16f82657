"""One Runge-Kutta step of a run as a generic function, which a kernel repeats: every lane is a run.  [H93 II.1]"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import numpy as np

from flexbase.control.null_space import Law
from flexbase.dynamics.kinematics import forward
from flexbase.dynamics.motion import equation_of_motion, under_gain
from flexbase.dynamics.rotation_vector import tip_error
from flexbase.dynamics.variation import varied_frames
from flexbase.model.digest import model_digest
from flexbase.plant import Pose
from flexbase.simulation.observed import measured
from flexbase.simulation.runge_kutta import BEGIN, END, MIDDLE, State, runge_kutta
from flexbase.simulation.settling import SETTLED, error_size
from flexbase.trace.algebra import (
    Matrix,
    Scalar,
    Vector,
    absolute,
    larger,
    ldl,
    scale,
    select,
    smaller,
    solve_ldl,
)

CLOCK = ("step", "begin", "switch")  # s: of the integrator, of the phase, of the move
WATCHED = ("taken", "peak", "outside", "speed", "pivot")  # beside q and rates; see `Step`
EDGE = 1e-9  # of a step: so far inside it lie its first and last look at the clock, for laws with jumps in between
LawOf = Callable[[Vector, Scalar], Law]  # of the n joints at the start and the move's duration


@dataclass(frozen=True, eq=False)
class Step:
    """A step of a phase. In: q, rates, `WATCHED`, then `CLOCK`, the start's n joints and the varied values.

    Out: q, rates and `WATCHED` a step later. taken : steps so far; peak : largest tip error; outside : the last step
    that began 0.1 mm or more away; speed : largest joint rate; pivot : least pivot of M - E. All are judged where steps
    begin.

    varied : names of `parameters_of`, or `task_stiffness`, `task_damping`, `compensation`: factors of the loop
    """

    goal: Pose
    law_of: LawOf
    E: Matrix | None
    varied: tuple[str, ...] = ()

    @property
    def state(self) -> int:
        """How many values a step changes."""
        return 2 * self.goal.arm.N + len(WATCHED)

    @property
    def inputs(self) -> int:
        """How many go in."""
        return self.state + len(CLOCK) + self.goal.arm.n + len(self.varied)

    def __call__(self, inputs: Vector) -> Sequence[Scalar]:
        """The generic function."""
        N, n = self.goal.arm.N, self.goal.arm.n
        q, rates = inputs[:N], inputs[N : 2 * N]
        taken, peak, outside, speed, least = inputs[2 * N : self.state]
        step, begin, switch, *rest = inputs[self.state :]
        law, values = self.law_of(rest[:n], switch), dict(zip(self.varied, rest[n:], strict=True))
        time, inside = begin + taken * step, EDGE * step
        when = {BEGIN: time + inside, MIDDLE: time + 0.5 * step, END: time + (step - inside)}

        def slope(where: float, moved: State) -> State:
            return moved[1], self._answer(law, values, when[where], *moved)[0]

        first, error, pivots = self._answer(law, values, when[BEGIN], q, rates)
        joints, speeds = runge_kutta(slope, (q, rates), step, (rates, first))

        size = error_size(error, self.goal.arm.task.rows)
        for pivot in pivots:
            least = smaller(least, pivot)
        for rate in rates:
            speed = larger(speed, absolute(rate))
        return [
            *joints,
            *speeds,
            taken + 1.0,
            larger(peak, size),
            select(size >= SETTLED, taken, outside),
            speed,
            least,
        ]

    def _answer(
        self, law: Law, values: dict[str, Scalar], time: Scalar, q: Vector, rates: Vector
    ) -> tuple[Vector, Vector, Vector]:
        """Accelerations, tip error, pivots of M - E: what the plant does under the law.  [U03 eq 1, 2, 11]"""
        arm = self.goal.arm
        frames = varied_frames(arm, forward(arm.mechanism, q), values)
        error = tip_error(frames, arm.task, self.goal.target)
        seen = measured(arm, frames, time, q, rates, error)
        felt = seen._replace(  # factors on a controller's gains act here, on the tip alone
            tip_error=scale(values.get("task_stiffness", 1.0), seen.tip_error),
            tip_rate=scale(values.get("task_damping", 1.0), seen.tip_rate),
        )
        torque = law.torque(felt)
        M, force = equation_of_motion(arm, frames, q, rates, torque, self.goal.equilibrium.tolist(), varied=values)
        unit, pivots = ldl(under_gain(arm, M, self.E, values.get("compensation", 1.0)))
        return solve_ldl(unit, pivots, force), error, pivots

    @property
    def recipe(self) -> str:
        """All that the step depends on, in words."""
        return f"{described(self.goal)}\n{described(self.law_of)}\nE {self.E!r}\nvaried {self.varied}"


def described(thing: Any) -> str:
    """A law, its poses, gains and paths in words that are equal only for equal ones."""
    if isinstance(thing, np.ndarray):
        return f"{thing.shape} {hashlib.sha256(np.ascontiguousarray(thing).tobytes()).hexdigest()}"
    if isinstance(thing, Pose):
        target = thing.target
        places = (thing.q, thing.equilibrium, target.position, target.rotation, thing.arm.gravity)
        return f"{model_digest(thing.arm)} {' '.join(map(described, places))}"
    if is_dataclass(thing) and not isinstance(thing, type):
        words = ", ".join(f"{one.name} {described(getattr(thing, one.name))}" for one in fields(thing))
        return f"{type(thing).__qualname__}({words})"
    return str(thing.__qualname__) if callable(thing) else repr(thing)
