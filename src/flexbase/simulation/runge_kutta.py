"""One step of the classical Runge-Kutta method of fourth order, on any number type.  [H93 II.1]"""

from __future__ import annotations

from collections.abc import Callable

from flexbase.trace.algebra import Scalar, Vector, add, mul

State = tuple[Vector, ...]  # parts, such as joints and rates
BEGIN, MIDDLE, END = 0.0, 0.5, 1.0  # where in a step a slope is asked for


def runge_kutta(
    slope: Callable[[float, State], State], state: State, time: Scalar, first: State | None = None
) -> State:
    """The state after a time, from its slope, part by part.

    slope : of where in the step, one of BEGIN, MIDDLE and END, and the state there; first : that at BEGIN, where it is
        known already
    """
    half = mul(0.5, time)
    if first is None:
        first = slope(BEGIN, state)
    second = slope(MIDDLE, _moved(state, half, first))
    third = slope(MIDDLE, _moved(state, half, second))
    fourth = slope(END, _moved(state, time, third))
    return tuple(
        tuple(x + time / 6.0 * (a + 2.0 * (b + c) + d) for x, a, b, c, d in zip(*part, strict=True))
        for part in zip(state, first, second, third, fourth, strict=True)
    )


def _moved(state: State, time: Scalar, slope: State) -> State:
    return tuple(
        tuple(add(x, mul(time, s)) for x, s in zip(part, along, strict=True))
        for part, along in zip(state, slope, strict=True)
    )
