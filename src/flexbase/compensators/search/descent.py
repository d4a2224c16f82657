"""Descent in the bounded parametrisation: the modal shortage as a function of a free symmetric matrix.  [theory §7]"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize

from flexbase.checks import Array
from flexbase.compensators.judge.gain_shortage import modal_shortage, working_damping
from flexbase.compensators.judge.implementable import BoundedGain
from flexbase.compensators.search.mode_parameters import symmetric, upper_triangle
from flexbase.linear.linearise import reduced_arrays
from flexbase.plant import Pose

STEPS = 400  # of BFGS
FLAT = 1e-10  # slope of the relative shortage at which it stops
SATURATION = 0.95  # share of the bound up to which a given gain is taken over as a start


def shortage_and_slope(pose: Pose, E: Array) -> tuple[float, Array]:
    """The modal shortage of a gain and its slope dJ/dE, symmetric, shape (n, n). Assumes M - E > 0."""
    reduced = reduced_arrays(pose, E)
    here = modal_shortage(pose.Jp, reduced.V, reduced.S, working_damping(pose), pose.arm.base.stiffness)
    force = np.linalg.solve(pose.Mhat - E, pose.Jv.T)
    slope = force @ here.slope_V @ reduced.W.T - reduced.W @ here.slope_S @ reduced.W.T  # d(X^-1) = X^-1 dE X^-1
    return here.value, 0.5 * (slope + slope.T)


def descend(pose: Pose, radius: float, start: Array) -> tuple[float, Array]:
    """The least shortage that BFGS finds from a gain, relative to no gain, and its E: rho(Ms^-1 E) < radius.

    Assumes that something is missing without a gain.
    """
    n, gain = pose.arm.n, BoundedGain(pose, radius)
    scale = shortage_and_slope(pose, np.zeros((n, n)))[0]
    double = 2.0 - np.eye(n)  # an entry off the diagonal stands for two

    def cost(entries: Array) -> tuple[float, Array]:
        E, vectors, angles = gain.at(symmetric(entries, n))
        value, slope = shortage_and_slope(pose, E)
        return value / scale, upper_triangle(double * gain.pull_back(slope, vectors, angles)) / scale

    first = upper_triangle(gain.parameter(start, SATURATION))
    found = minimize(cost, first, jac=True, method="BFGS", options={"maxiter": STEPS, "gtol": FLAT})
    E, _, _ = gain.at(symmetric(found.x, n))
    return float(found.fun), 0.5 * (E + E.T)
