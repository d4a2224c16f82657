"""Motion laws from rest to rest, and joint paths that follow them, on any number type."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from flexbase.trace.algebra import Scalar, Vector, larger, minus, select, smaller

Law = Callable[[Scalar], tuple[Scalar, Scalar, Scalar]]


def quintic(u: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """Fifth-order polynomial over 0 <= u <= 1: position, velocity and acceleration; all start and end at rest."""
    return (
        u * u * u * (10.0 + u * (6.0 * u - 15.0)),
        u * u * (30.0 + u * (30.0 * u - 60.0)),
        u * (60.0 + u * (120.0 * u - 180.0)),
    )


def trapezoidal(u: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """Trapezoidal velocity over 0 <= u <= 1: a third each of speeding up, cruising and braking."""
    ramp, peak = 1.0 / 3.0, 1.5
    slope, rest = peak / ramp, 1.0 - u

    def phase(speeding: Scalar, cruising: Scalar, braking: Scalar) -> Scalar:
        return select(u < ramp, speeding, select(u <= 1.0 - ramp, cruising, braking))

    return (
        phase(0.5 * slope * (u * u), peak * (u - 0.5 * ramp), 1.0 - 0.5 * slope * (rest * rest)),
        phase(slope * u, peak, slope * rest),
        phase(slope, 0.0, -slope),
    )


LAWS: dict[str, Law] = {"quintic": quintic, "trapezoidal": trapezoidal}
SMOOTH_PARTS = {"quintic": 1, "trapezoidal": 3}  # equal parts of 0 <= u <= 1 within which a law is smooth


@dataclass(frozen=True, eq=False)
class JointPath:
    """A straight line in joint space from `start` to `end`, n joints each, in `duration` seconds, then at rest."""

    start: Vector
    end: Vector
    duration: Scalar
    law: Law

    def at(self, time: Scalar) -> tuple[Vector, Vector, Vector]:
        """Wanted joints, rates and accelerations at a time or a batch of times."""
        u = smaller(larger(time / self.duration, 0.0), 1.0)
        position, velocity, acceleration = self.law(u)
        pushed = select(u < 1.0, acceleration, 0.0)
        span = minus(self.end, self.start)
        return (
            tuple(start + position * way for start, way in zip(self.start, span, strict=True)),
            tuple(velocity * way / self.duration for way in span),
            tuple(pushed * way / (self.duration * self.duration) for way in span),
        )
