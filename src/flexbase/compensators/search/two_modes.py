"""Both modes of a two-joint base aligned, each with a beta of its own: one angle, semidefinite programs.  [theory §7]

Shapes with Phi^T Kp Phi = I are Kp^(-1/2) times a rotation: one angle theta for two base joints. At a given theta the
conditions that Phi are the modes, phi_1^T S phi_2 = 0, and aligned, V phi_i = beta_i Jp phi_i, are affine in the
mobility and the betas. So a scan over theta and the signs of the betas finds a gain wherever there is one.
"""

from __future__ import annotations

from itertools import product
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from flexbase.checks import Array
from flexbase.compensators.judge.gain_shortage import working_damping
from flexbase.compensators.judge.lag_law import LagLaw
from flexbase.compensators.search.mobility_program import (
    FAR,
    REACHED,
    ROOM,
    SIDES,
    MobilityProgram,
    Side,
    lagged_directions,
    least_change,
    symmetric_basis,
)
from flexbase.errors import Infeasible

ANGLES = 24  # of the scan over a quarter turn; the other quarters only swap the modes or their signs
REFINED = 3  # lowest places of the scan that are followed where the scan by itself finds no gain
STEPS = 14  # of each of them
FINALISTS = 3  # cells of the scan among which the smallest change is taken
NEVER = 1e3  # box widths: no gain at this angle, a number so that a minimiser can compare it
SHARE = 0.5  # of the largest reachable distance of the betas from (0, 1)
COUPLED = 0.99  # bound on the ratio of the distances, above which it counts as one beta for both modes


class Cell(NamedTuple):
    """An angle, the sides of the two betas, and by how much the box must be widened for a gain: below 0, not at all."""

    wider: float
    angle: float
    sides: tuple[Side, Side]


class TwoModes:
    """The programs of one pose, stated once for all angles. Assumes two base joints, Kp > 0, a program without a law.

    law : the delay law, for both modes, if any
    """

    def __init__(self, program: MobilityProgram, law: LagLaw | None = None) -> None:
        self.program, self.law = program, law
        cp = program.cp
        self.root = np.linalg.inv(np.linalg.cholesky(program.Kp)).T
        self.root *= np.sqrt(np.trace(program.Kp) / np.trace(program.Mpp))  # shapes of size 1 in the base's inertia
        self.damping = working_damping(program.pose)
        tip = np.linalg.cholesky(program.A @ program.A.T)
        self.to_tip = np.linalg.inv(tip)
        n, k = len(program.B), len(program.A)
        self.driven, self.moved, self.coupling = cp.Parameter((n, 2)), cp.Parameter((k, 2)), cp.Parameter()
        self.outer, self.least = cp.Parameter(2), cp.Parameter()
        self.lag_pull, self.lag_eased = cp.Parameter(2, nonneg=True), cp.Parameter((n, 2))
        self.lag_offset, self.lag_size = cp.Parameter(2), cp.Parameter(2, nonneg=True)
        self.ratio, self.pull, self.offset = cp.Parameter(nonneg=True), cp.Parameter(nonneg=True), cp.Parameter()
        self.beta, self.wider = cp.Variable(2), cp.Variable()
        self.distance, self.follow = cp.Variable(2), cp.Variable((n, 2))  # of each beta from (0, 1); Z driven
        self.problems = {same: self._problems(same) for same in (True, False)}

    def gain(self, margin: float) -> Array | None:
        """E of a small change of the mobility with both modes aligned; None where the constraints exclude it."""
        cells = self.cells()
        inside = [cell for cell in cells if cell.wider < -ROOM] or [
            cell for cell in self._followed(cells) if cell.wider < -ROOM
        ]
        found = [self._least_change(cell, margin) for cell in inside[:FINALISTS]]
        return min((one for one in found if one is not None), key=lambda one: one[0], default=(0.0, None))[1]

    def widening(self) -> float:
        """By how much the box must be widened, at the least; below 0 where it has room."""
        cells = self.cells()
        return min(cell.wider for cell in [*cells[:1], *(self._followed(cells) if cells[0].wider >= -ROOM else [])])

    def cells(self) -> list[Cell]:
        """The scan, best first."""
        angles = 0.5 * np.pi * np.arange(ANGLES) / ANGLES
        return sorted(self._cell(float(angle), (i, j)) for i, j in product(SIDES, SIDES) for angle in angles)

    def _followed(self, cells: list[Cell]) -> list[Cell]:
        """The lowest places of the scan, each minimised between its neighbours; best first."""
        step, followed = 0.5 * np.pi / ANGLES, []
        for cell in cells[:REFINED]:
            tried: list[Cell] = [cell]

            def wider(angle: float, sides: tuple[Side, Side] = cell.sides, tried: list[Cell] = tried) -> float:
                tried.append(self._cell(angle, sides))
                return tried[-1].wider

            bounds = cell.angle - step, cell.angle + step
            minimize_scalar(wider, bounds=bounds, method="bounded", options={"maxiter": STEPS, "xatol": 1e-5})
            followed.append(min(tried))
        return sorted(followed)

    def _cell(self, angle: float, sides: tuple[Side, Side]) -> Cell:
        if not self._set(angle, sides):
            return Cell(NEVER, angle, sides)
        try:
            value = self.program.run(self.problems[sides[0] == sides[1]][0])
        except Infeasible:  # the solver gave up at this angle; there are others
            value = None
        return Cell(NEVER if value is None else value, angle, sides)

    def _set(self, angle: float, sides: tuple[Side, Side]) -> bool:
        """Give the programs an angle and sides; False where the damping couples the modes too much for them."""
        program, (c, s) = self.program, (np.cos(angle), np.sin(angle))
        shapes = self.root @ np.array([[c, -s], [s, c]])
        self.driven.value = program.B @ shapes
        self.moved.value = self.to_tip @ program.Jp @ shapes
        self.coupling.value = float(shapes[:, 0] @ program.Mpp @ shapes[:, 1])
        self.outer.value, self.least.value = np.array(sides, dtype=float), REACHED
        if self.law is not None:
            laws = lagged_directions(program, self.law, shapes)
            self.lag_pull.value, self.lag_offset.value, self.lag_size.value = (
                np.array([getattr(one, name) for one in laws]) for name in ("pull", "offset", "size")
            )
            self.lag_eased.value = np.column_stack([one.eased for one in laws])
        ratio = damping_ratio_bound(shapes.T @ self.damping @ shapes)
        self.ratio.value = ratio
        if sides[0] == sides[1]:
            return True
        if ratio > COUPLED:
            return False
        self.pull.value, self.offset.value = np.sqrt(ratio) / (1.0 - ratio), ratio / (1.0 - ratio)
        return True

    def _problems(self, same: bool) -> tuple[Any, Any, Any]:
        """The least widening of the box, the largest distance of the betas from (0, 1), the least change."""
        program, cp = self.program, self.program.cp
        Z, A = program.Z, self.to_tip @ program.A
        far = [
            self.follow == Z @ self.driven,
            A @ self.follow == cp.multiply(self.moved, cp.reshape(self.beta, (1, 2), order="C")),
            self.coupling - self.driven[:, 0] @ self.follow[:, 1] == 0,
            self.distance == cp.multiply(self.outer, self.beta) - 0.5 * (self.outer + 1.0),
            self.distance >= self.least,
            *self._bearable(same),
        ]
        inside = [*program.inside, *program.bounds, *self._delay_law()]
        least, change = cp.Variable(), cp.norm(Z - np.eye(len(program.B)), "fro")
        return (
            cp.Problem(cp.Minimize(self.wider), [*program.widened(self.wider), *self._delay_law(self.wider), *far]),
            cp.Problem(cp.Maximize(least), [*inside, *far, self.distance >= least, least <= FAR]),
            cp.Problem(cp.Minimize(change), [*inside, *far]),
        )

    def _delay_law(self, wider: Any = 0.0) -> list[Any]:
        """The law for both modes, exact, as their shapes are given at each angle.  [theory §8]"""
        if self.law is None:
            return []
        cp, follow = self.program.cp, self.follow
        return [
            self.lag_pull[i] * cp.sum_squares(follow[:, i]) - self.lag_eased[:, i] @ follow[:, i]
            <= self.lag_offset[i] + wider * self.lag_size[i]
            for i in (0, 1)
        ]

    def _bearable(self, same: bool) -> list[Any]:
        """c_1/c_2 between t and 1/t, c = beta/(beta - 1): the damping then couples no mode into another's rest.

        On one side, u_1/u_2 between t and 1/t is enough, u the distances from (0, 1); on two sides the bound is
        (u_1 - o)(u_2 - o) >= t/(1 - t)^2 with o = t/(1 - t), exactly.
        """
        u = self.distance
        if same:
            return [u[0] >= self.ratio * u[1], u[1] >= self.ratio * u[0]]
        cp = self.program.cp
        corner = cp.reshape(self.pull, (1, 1), order="C")
        first, second = (cp.reshape(u[i] - self.offset, (1, 1), order="C") for i in (0, 1))
        return [cp.bmat([[first, corner], [corner, second]]) >> 0]

    def _least_change(self, cell: Cell, margin: float) -> tuple[float, Array] | None:
        """The smallest change in a cell, the betas as far from (0, 1) as asked, or half as far as can be."""
        self._set(cell.angle, cell.sides)
        _, farthest, change = self.problems[cell.sides[0] == cell.sides[1]]
        try:
            reach = self.program.run(farthest)
            if reach is None:
                return None
            self.least.value = max(REACHED, min(margin, SHARE * reach))
            value = self.program.run(change)
        except Infeasible:
            return None
        return (
            None if value is None else (value, self.program.box.gain(self._polished(np.asarray(self.program.Z.value))))
        )

    def _polished(self, Z: Array) -> Array:
        """The nearest mobility that meets the equations of alignment to rounding."""
        A, basis = self.to_tip @ self.program.A, symmetric_basis(len(Z))
        driven, beta = self.driven.value, self.beta.value

        def left(matrix: Array) -> Array:
            follow = matrix @ driven
            return np.append((A @ follow).ravel(), driven[:, 0] @ follow[:, 1])

        wanted = np.append((self.moved.value * beta).ravel(), self.coupling.value)
        return Z + least_change(np.array([left(matrix) for matrix in basis]).T, wanted - left(Z), basis)


def damping_ratio_bound(modal: Array) -> float:
    """t <= 1 such that modal damping d bears any c_1/c_2 in [t, 1/t]: d diag(c) + diag(c) d >= 0. 0 where uncoupled.

    The determinant: (c_1 + c_2)^2 / (4 c_1 c_2) <= d_11 d_22 / d_12^2.
    """
    own = float(modal[0, 0] * modal[1, 1])
    share = min(1.0, float(modal[0, 1]) ** 2 / own) if own > 0.0 else 0.0
    return float(share / (1.0 + np.sqrt(1.0 - share)) ** 2)
