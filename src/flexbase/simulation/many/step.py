"""One Runge-Kutta step of a run as a generic function, which a kernel repeats: every lane is a run.  [H93 II.1]"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import numpy as np

from flexbase.control.measured import Measured
from flexbase.control.null_space import Law
from flexbase.dynamics.forces import bias_forces
from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import Frames, forward, task_jacobian
from flexbase.dynamics.rotation_vector import tip_error
from flexbase.dynamics.variation import varied_base, varied_frames
from flexbase.model.digest import model_digest
from flexbase.plant import Pose
from flexbase.simulation.result import SETTLED
from flexbase.trace.algebra import (
    Matrix,
    Scalar,
    Vector,
    absolute,
    add,
    larger,
    ldl,
    matvec,
    minus,
    mul,
    norm,
    plus,
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
        time, half, inside = begin + taken * step, 0.5 * step, EDGE * step

        first, error, pivots = self._answer(law, values, time + inside, q, rates)
        rates2 = _moved(rates, half, first)
        second = self._answer(law, values, time + half, _moved(q, half, rates), rates2)[0]
        rates3 = _moved(rates, half, second)
        third = self._answer(law, values, time + half, _moved(q, half, rates2), rates3)[0]
        rates4 = _moved(rates, step, third)
        fourth = self._answer(law, values, time + (step - inside), _moved(q, step, rates3), rates4)[0]

        size = self.size(error)
        for pivot in pivots:
            least = smaller(least, pivot)
        for rate in rates:
            speed = larger(speed, absolute(rate))
        return [
            *_advanced(q, step, rates, rates2, rates3, rates4),
            *_advanced(rates, step, first, second, third, fourth),
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
        m = arm.m
        frames = varied_frames(arm, forward(arm.mechanism, q), values)
        error = tip_error(frames, arm.task, self.goal.target)
        torque = law.torque(self._seen(frames, values, time, q, rates, error))
        spring = minus(
            matvec(varied_base(arm, "stiffness", values), minus(self.goal.equilibrium.tolist(), q[:m])),
            matvec(varied_base(arm, "damping", values), rates[:m]),
        )
        rubbed = [mul(float(c), rate) for c, rate in zip(arm.mechanism.friction, rates, strict=True)]
        resisted = plus(bias_forces(frames, rates, arm.gravity.tolist()), rubbed)
        unit, pivots = ldl(self._inertia(mass_matrix(frames), values))
        return solve_ldl(unit, pivots, minus((*spring, *torque), resisted)), error, pivots

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

    def _inertia(self, M: Matrix, values: dict[str, Scalar]) -> Matrix:
        """M - blkdiag(0, E)."""
        if self.E is None:
            return M
        m, share = self.goal.arm.m, values.get("compensation", 1.0)
        return tuple(
            tuple(entry - mul(share, self.E[i - m][j - m]) if min(i, j) >= m else entry for j, entry in enumerate(row))
            for i, row in enumerate(M)
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


def _moved(x: Vector, time: Scalar, slope: Vector) -> Vector:
    return tuple(add(entry, mul(time, change)) for entry, change in zip(x, slope, strict=True))


def _advanced(x: Vector, time: Scalar, one: Vector, two: Vector, three: Vector, four: Vector) -> list[Scalar]:
    parts = zip(x, one, two, three, four, strict=True)
    return [value + time / 6.0 * (a + 2.0 * (b + c) + d) for value, a, b, c, d in parts]
