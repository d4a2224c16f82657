"""The least-misaligned gain: each mode near a beta of its own, where one beta for all has no solution.  [theory §7]"""

from __future__ import annotations

from itertools import product

import numpy as np
import scipy.linalg

from flexbase.checks import Array
from flexbase.compensators.judge.lag_law import obeys
from flexbase.compensators.search.descent import shortage_and_slope
from flexbase.compensators.search.mobility_program import SIDES, MobilityProgram, Side
from flexbase.errors import Infeasible
from flexbase.linear.linearise import reduced_arrays

MARGIN = 0.1  # distance of beta from (0, 1), where the modes would be lost to the task force or to the tip
PASSES = 6
FINALISTS = 2  # sign patterns that go beyond the first pass
SETTLED = 1e-3  # relative gain of a pass below which the pattern is left
SMALLEST = 1e-3  # of |Jp phi|^2: floor of |a||b| in the weights, where a mode is nearly lost to force or tip


def least_misalignment(program: MobilityProgram, margin: float) -> Array:
    """E of the smallest modal shortage found over the sign patterns of beta_i, Phi re-solved between passes.

    The program's delay law is stated anew with Phi; only a gain that obeys it with its own modes is taken.
    Raises Infeasible where the constraints exclude each other.
    """
    m = program.pose.arm.m
    none = np.zeros_like(program.box.L)
    patterns: list[tuple[Side, ...]] = list(product(SIDES, repeat=m))
    first = [
        (_missing(program, E), pattern, E)
        for pattern in patterns
        if (E := _pass(program, none, pattern, margin)) is not None
    ]
    if not first:
        lag = "" if program.law is None else "the lag, "
        raise Infeasible(f"{lag}the natural frequencies and the radius exclude each other. Ask for others.")
    first.sort(key=lambda entry: entry[0])
    found = [(value, E) for value, _, E in first]
    for start, pattern, E in first[:FINALISTS]:
        value = start
        for _ in range(PASSES - 1):
            following = _pass(program, E, pattern, margin)
            if following is None:
                break
            E, previous = following, value
            value = _missing(program, E)
            found.append((value, E))
            if value > (1.0 - SETTLED) * previous and obeys(program.law, program.pose, E):
                break
    allowed = [one for one in found if obeys(program.law, program.pose, one[1])]
    if not allowed:
        raise Infeasible("the delay law binds: no pass ended in a gain whose own modes obey it. Ask for a smaller lag.")
    return min(allowed, key=lambda one: one[0])[1]


def _missing(program: MobilityProgram, E: Array) -> float:
    return shortage_and_slope(program.pose, E)[0]


def _pass(program: MobilityProgram, E: Array, pattern: tuple[Side, ...], margin: float) -> Array | None:
    """One convex problem at the mode shapes of E. c_i |V phi - beta Jp phi|^2 is then nearly |w_i| / omega_i."""
    if program.law is not None:
        program = program.under(program.law, E)
        if not program.reaches_frequencies():  # the solver is kept away from infeasible programs
            return None
    reduced = reduced_arrays(program.pose, E)
    squares, shapes = scipy.linalg.eigh(program.Kp, reduced.S)
    tip = np.sum((program.Jp @ shapes) ** 2, axis=0)
    sizes = np.linalg.norm((reduced.V - program.Jp) @ shapes, axis=0) * np.linalg.norm(reduced.V @ shapes, axis=0)
    floor = np.maximum(sizes, SMALLEST * tip)
    weights = np.where(tip > 0.0, tip, 1.0) / (2.0 * np.where(floor > 0.0, floor, 1.0) * np.sqrt(squares))
    solution = program.least_mismatch(shapes, weights / weights.max(), pattern, margin)
    return None if solution is None else program.box.gain(solution.mobility)
