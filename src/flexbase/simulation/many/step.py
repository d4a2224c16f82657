"""One Runge-Kutta step of a run as a generic function, which a kernel repeats: every lane is a run.  [H93 II.1]"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import numpy as np

from flexbase.control.measured import Measured
from flexbase.control.null_space import Law
from flexbase.dynamics.kinematics import Frames, forward, task_jacobian
from flexbase.dynamics.motion import equation_of_motion, under_gain
from flexbase.dynamics.rotation_vector import tip_error
from flexbase.dynamics.variation import varied_frames
from flexbase.model.digest import model_digest
from flexbase.plant import Pose
from flexbase.simulation.result import SETTLED
from flexbase.simulation.runge_kutta import BEGIN, END, MIDDLE, State, runge_kutta
from flexbase.trace.algebra import (
    Matrix,
    Scalar,
    Vector,
    absolute,
    larger,
    ldl,
    matvec,
    norm,
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

        size = self.size(error)
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
        torque = law.torque(self._seen(frames, values, time, q, rates, error))
        M, force = equation_of_motion(arm, frames, q, rates, torque, self.goal.equilibrium.tolist(), varied=values)
        unit, pivots = ldl(under_gain(arm, M, self.E, values.get("compensation", 1.0)))
        return solve_ldl(unit, pivots, force), error, pivots

    def _seen(
        self, frames: Frames, values: dict[str, Scalar], time: Scalar, q: Vector, rates: Vector, error: Vector
    ) -> Measured:
        """What the controller sees. Factors on its gains act here, on the tip alone."""
        arm = self.goal.arm
        tip_rate = matvec(task_jacobian(frames, arm.task.indices), rates)
        return Measured(
            time,
            q[arm.m :],
            rates[arm.m :],
            scale(values.get("task_stiffness", 1.0), error),
            scale(values.get("task_damping", 1.0), tip_rate),
        )

    def size(self, error: Vector) -> Scalar:
        """Length of the tip error: positions in m, or rotations in rad where larger."""
        rows = self.goal.arm.task.rows
        sizes = [
            norm([entry for entry, row in zip(error, rows, strict=True) if row.startswith("r") == turns])
            for turns in (False, True)
            if any(row.startswith("r") == turns for row in rows)
        ]
        return sizes[0] if len(sizes) == 1 else larger(*sizes)

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
