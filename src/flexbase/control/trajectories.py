"""Motion laws from rest to rest, and joint paths that follow them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from flexbase.checks import Array
from flexbase.trace.algebra import Scalar, Vector

Law = Callable[[Array], tuple[Array, Array, Array]]


def quintic(u: Array) -> tuple[Array, Array, Array]:
    """Fifth-order polynomial over 0 <= u <= 1: position, velocity and acceleration; all start and end at rest."""
    return (
        u**3 * (10.0 - 15.0 * u + 6.0 * u**2),
        u**2 * (30.0 - 60.0 * u + 30.0 * u**2),
        u * (60.0 - 180.0 * u + 120.0 * u**2),
    )


def trapezoidal(u: Array) -> tuple[Array, Array, Array]:
    """Trapezoidal velocity over 0 <= u <= 1: a third each of speeding up, cruising and braking."""
    ramp, peak = 1.0 / 3.0, 1.5
    slope = peak / ramp
    phases = [u < ramp, u <= 1.0 - ramp]
    return (
        np.select(phases, [0.5 * slope * u**2, peak * (u - 0.5 * ramp)], 1.0 - 0.5 * slope * (1.0 - u) ** 2),
        np.select(phases, [slope * u, np.full_like(u, peak)], slope * (1.0 - u)),
        np.select(phases, [np.full_like(u, slope), np.zeros_like(u)], np.full_like(u, -slope)),
    )


LAWS: dict[str, Law] = {"quintic": quintic, "trapezoidal": trapezoidal}


@dataclass(frozen=True, eq=False)
class JointPath:
    """A straight line in joint space from `start` to `end`, shape (n,), in `duration` seconds, then at rest."""

    start: Array
    end: Array
    duration: float
    law: Law

    def at(self, time: Scalar) -> tuple[Vector, Vector, Vector]:
        """Wanted joints, rates and accelerations at a time or a batch of times."""
        u = np.clip(np.asarray(time, dtype=float) / self.duration, 0.0, 1.0)
        position, velocity, acceleration = self.law(u)
        moving = u < 1.0
        span = self.end - self.start
        return (
            tuple(start + position * way for start, way in zip(self.start, span, strict=True)),
            tuple(velocity * way / self.duration for way in span),
            tuple(np.where(moving, acceleration, 0.0) * way / self.duration**2 for way in span),
        )
