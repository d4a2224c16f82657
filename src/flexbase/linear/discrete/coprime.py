"""Robust stabilisation of normalised coprime factors: the controller that bears the largest error of the plant.

The plant is N M^-1 with coprime factors of unit size; a controller with margin b stabilises every (N + dN)(M + dM)^-1
whose errors stay below b. McFarlane and Glover (1990); the formulas are those of [theory §10].
"""

from __future__ import annotations

import numpy as np

from flexbase.linear.discrete import riccati
from flexbase.linear.discrete.system import Discrete
from flexbase.linear.discrete.tustin import to_continuous, to_discrete
from flexbase.linear.second_order import StateSpace


def coprime_controller(plant: Discrete, factor: float = 1.1) -> tuple[Discrete, float]:
    """The central controller u = K y at gamma = factor / b_opt, of the plant's order, and b_opt.

    Assumes a stabilisable and detectable plant. The controller's margin b is at least b_opt / factor.

    factor : above 1; the nearer, the faster the controller's own poles
    Raises Unsolvable where a Riccati equation has no stabilising solution.
    """
    continuous = to_continuous(plant)
    A, B, C, D = continuous
    S, R = np.eye(B.shape[1]) + D.T @ D, np.eye(len(C)) + D @ D.T
    shifted = A - B @ np.linalg.solve(S, D.T @ C)
    X = riccati.continuous(shifted, B, C.T @ np.linalg.solve(R, C), S)
    Z = riccati.continuous(shifted.T, C.T, B @ np.linalg.solve(S, B.T), R)
    largest = max(float(np.linalg.eigvals(X @ Z).real.max()), 0.0)
    b_opt = float((1.0 + largest) ** -0.5)
    gamma = factor / b_opt
    F = -np.linalg.solve(S, D.T @ C + B.T @ X)
    W = np.eye(len(A)) + X @ Z - gamma**2 * np.eye(len(A))  # regular: gamma^2 is above each eigenvalue of I + X Z
    gain = gamma**2 * np.linalg.solve(W.T, Z @ C.T)
    controller = StateSpace(np.asarray(A + B @ F + gain @ (C + D @ F)), np.asarray(gain), B.T @ X, -D.T)
    return to_discrete(controller, plant.step), b_opt
