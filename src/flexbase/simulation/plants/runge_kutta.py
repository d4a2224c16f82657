"""One step of the classical Runge-Kutta method of fourth order, on any number type.  [H93 II.1]"""

from __future__ import annotations

from collections.abc import Callable

from flexbase.trace.algebra import Scalar, Vector, add, mul

State = tuple[Vector, ...]  # parts, such as joints and rates


def runge_kutta(slope: Callable[[State], State], state: State, time: Scalar) -> State:
    """The state after a time, from its slope, part by part."""
    half = mul(0.5, time)
    first = slope(state)
    second = slope(_moved(state, half, first))
    third = slope(_moved(state, half, second))
    fourth = slope(_moved(state, time, third))
    return tuple(
        tuple(x + time / 6.0 * (a + 2.0 * (b + c) + d) for x, a, b, c, d in zip(*part, strict=True))
        for part in zip(state, first, second, third, fourth, strict=True)
    )


def _moved(state: State, time: Scalar, slope: State) -> State:
    return tuple(
        tuple(add(x, mul(time, s)) for x, s in zip(part, along, strict=True))
        for part, along in zip(state, slope, strict=True)
    )
