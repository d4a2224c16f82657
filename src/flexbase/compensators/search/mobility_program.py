"""The semidefinite program of the convex designs: the arm's mobility in a box, what is affine in it.  [theory §7]"""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

import numpy as np

from flexbase.checks import Array
from flexbase.compensators.judge.implementable import mobility_box
from flexbase.compensators.judge.lag_law import CLEAR, LagLaw, pumping, relief
from flexbase.errors import Infeasible, import_extra
from flexbase.plant import Pose

Side = Literal[-1, 1]
SIDES: tuple[Side, Side] = (-1, 1)  # beta <= 0 and beta >= 1
SOLVED = ("optimal", "optimal_inaccurate")
STILL = 1e-9  # size of Jp, scaled, up to which the base does not move the tip
ROOM = 1e-7  # of the box's width that has to be left: the solver's accuracy
REACHED = 1e-5  # distance of beta from (0, 1) below which the modes count as lost
FAR = 1e3  # the same, above which it is not pursued: Jp is next to nothing then
IMPOSSIBLE = ("infeasible", "infeasible_inaccurate")


class Solution(NamedTuple):
    """A mobility L^T Y L, its beta, and the objective there."""

    mobility: Array
    beta: float
    value: float


class LaggedDirection(NamedTuple):
    """pull |Z b|^2 - eased.Z b <= offset: the delay law of one shape, over 1 + r.  [theory §8]

    driven : b = L^-1 Map psi, shape (n,)
    size : |b|^2 / (1 + r), by which the law is eased
    """

    driven: Array
    pull: float
    eased: Array
    offset: float
    size: float


class MobilityProgram:
    """Variables Z = L^T Y L (Mhat = L L^T) and beta; always the box of theory §8, optional bounds on the frequencies.

    Optional too, the delay law, stated for the mode shapes under the gain `around` (none if left out): exact for one
    base joint, whose shape cannot change.
    Rows and columns of V = beta Jp are scaled by the tip's mobility and the base's inertia, which leaves its solutions.
    Needs the extra "convex".
    """

    def __init__(
        self,
        pose: Pose,
        radius: float,
        lowest: float | None = None,
        highest: float | None = None,
        law: LagLaw | None = None,
        around: Array | None = None,
    ) -> None:
        self.cp: Any = import_extra("cvxpy", "convex")
        import_extra("clarabel", "convex")
        self.pose, self.radius, self.lowest, self.highest = pose, radius, lowest, highest
        m = pose.arm.m
        self.box = mobility_box(pose, radius)
        self.A = np.linalg.solve(self.box.L, pose.Jv.T).T  # V = A Z B
        self.B = np.linalg.solve(self.box.L, pose.Map)  # S = Mpp - B^T Z B
        self.Jp, self.Mpp, self.Kp = pose.Jp, pose.Mpp, pose.arm.base.stiffness
        tip, base = np.linalg.cholesky(self.A @ self.A.T), np.linalg.cholesky(self.Mpp)
        self.rows = np.linalg.inv(tip) @ self.A
        self.columns = np.linalg.solve(base, self.B.T).T
        self.goal = np.linalg.solve(base, (np.linalg.inv(tip) @ self.Jp).T).T
        self._frequency = float(np.sqrt(np.trace(self.Kp) / np.trace(self.Mpp)))
        n = len(self.B)
        self.Q = self.cp.Variable((n, n), symmetric=True)  # the box is 0 <= Q <= I
        root = np.linalg.cholesky(self.box.upper - self.box.lower)
        self.Z = self.box.lower + root @ self.Q @ root.T
        self.inside = [self.Q >> 0, np.eye(n) - self.Q >> 0]
        self.law = law
        self.shapes = np.eye(m)
        if law is not None and m > 1:
            self.shapes = pumping(pose, np.zeros((n, n)) if around is None else around).shapes
        self.shapes = self.shapes / np.sqrt(np.diag(self.shapes.T @ self.Mpp @ self.shapes))
        self.bounds = [*self._frequency_bounds(), *self._delay_law()]

    @property
    def bounded(self) -> bool:
        """Whether the frequencies are bounded."""
        return self.lowest is not None or self.highest is not None

    def under(self, law: LagLaw | None, around: Array | None = None) -> MobilityProgram:
        """The same with another delay law, or with the law stated for the mode shapes under another gain."""
        return MobilityProgram(self.pose, self.radius, self.lowest, self.highest, law, around)

    def gain(self, solution: Solution) -> Array:
        """E of a solution, after V = beta Jp is met to rounding by the nearest Z."""
        lines, basis = self._linear_map()
        missing = solution.beta * self.goal - self.rows @ solution.mobility @ self.columns
        return self.box.gain(solution.mobility + least_change(lines, missing.ravel(), basis))

    def misfit(self) -> float:
        """Smallest |V - Jp| / |Jp| over all symmetric Z: zero where V = beta Jp has any, infinite if Jp = 0."""
        size = float(np.linalg.norm(self.goal))
        if size <= STILL:
            return float(np.inf)
        lines, _ = self._linear_map()
        best = np.linalg.lstsq(lines, self.goal.ravel(), rcond=None)[0]
        return float(np.linalg.norm(lines @ best - self.goal.ravel())) / size

    def residual(self, E: Array) -> float:
        """|V - beta Jp| / |Jp| of a gain, with its best beta. Assumes a finite `misfit`."""
        Z = np.linalg.inv(np.eye(len(E)) - np.linalg.solve(self.box.L, np.linalg.solve(self.box.L, E).T))
        V, size = self.rows @ Z @ self.columns, float(np.sum(self.goal**2))
        return float(np.linalg.norm(V - np.sum(V * self.goal) / size * self.goal) / np.sqrt(size))

    def farthest(self, side: Side) -> float | None:
        """Largest distance of beta from (0, 1) on one side; None where the constraints exclude V = beta Jp."""
        beta = self.cp.Variable()
        equality, away = self._equality(beta), side * beta >= REACHED + (side > 0)
        if not self._has_room([*equality, away]):
            return None
        near = side * beta <= FAR
        self.solve(self.cp.Maximize(side * beta), [*self.inside, *self.bounds, *equality, near])
        return float(side * beta.value) - (side > 0)

    def least_change(self, side: Side, margin: float) -> Solution | None:
        """The smallest ||Z - I||_F = ||L^T (Y - Mhat^-1) L||_F with beta at least `margin` outside (0, 1)."""
        beta = self.cp.Variable()
        away = side * beta >= margin + (side > 0)
        change = self.cp.norm(self.Z - np.eye(len(self.B)), "fro")
        value = self.solve(self.cp.Minimize(change), [*self.inside, *self.bounds, *self._equality(beta), away])
        return None if value is None else Solution(np.asarray(self.Z.value), float(beta.value), value)

    def least_mismatch(
        self, shapes: Array, weights: Array, pattern: tuple[Side, ...], margin: float
    ) -> Solution | None:
        """The smallest sum_i c_i |V phi_i - beta_i Jp phi_i|^2, each beta_i on its side.  [theory §7]"""
        cp, outer = self.cp, np.array(pattern)
        beta = cp.Variable(len(pattern))
        gap = self.A @ self.Z @ (self.B @ shapes) - cp.multiply(self.Jp @ shapes, cp.reshape(beta, (1, -1), order="C"))
        scaled = cp.multiply(gap, np.sqrt(weights)[None, :])
        away = cp.multiply(outer, beta) >= margin + (outer > 0)
        value = self.solve(cp.Minimize(cp.sum_squares(scaled)), [*self.inside, *self.bounds, away])
        return None if value is None else Solution(np.asarray(self.Z.value), float("nan"), value)

    def reaches_frequencies(self) -> bool:
        """Whether the box by itself allows the bounds on the frequencies, and the delay law."""
        return self._has_room([])

    def reachable_frequencies(self) -> tuple[float, float]:
        """The highest slowest and the lowest fastest frequency inside the box [rad/s]."""
        cp, ends = self.cp, []
        ratio, S, K = cp.Variable(), self._scaled_inertia(), self._scaled_stiffness()
        for goal, bound in ((cp.Minimize(ratio), ratio * K - S), (cp.Maximize(ratio), S - ratio * K)):
            self.solve(goal, [*self.inside, bound >> 0])
            ends.append(self._frequency / float(np.sqrt(ratio.value)))
        return ends[0], ends[1]

    def widened(self, wider: Any) -> list[Any]:
        """The box, the bounds on the frequencies and the delay law, eased by `wider` of the box's width."""
        eye = np.eye(len(self.B))
        box = [self.Q + wider * eye >> 0, (1.0 + wider) * eye - self.Q >> 0, wider >= -1.0]
        return [*box, *self._frequency_bounds(wider), *self._delay_law(wider)]

    def _frequency_bounds(self, wider: Any = 0.0) -> list[Any]:
        """omega >= lowest for all modes is S <= Kp / lowest^2, and so on: linear in Z; eased by `wider`. [theory §7]"""
        bounds, eased = [], wider * np.eye(len(self.Mpp))
        if self.lowest is not None and self.lowest == self.highest:
            return [self._scaled_inertia() == (self._frequency / self.lowest) ** 2 * self._scaled_stiffness()]
        if self.lowest is not None:
            bounds.append(
                (self._frequency / self.lowest) ** 2 * self._scaled_stiffness() - self._scaled_inertia() + eased >> 0
            )
        if self.highest is not None:
            bounds.append(
                self._scaled_inertia() - (self._frequency / self.highest) ** 2 * self._scaled_stiffness() + eased >> 0
            )
        return bounds

    def _delay_law(self, wider: Any = 0.0) -> list[Any]:
        """|Z b|^2 - b^T Z b <= r psi^T S psi with b = L^-1 Map psi, for each psi: convex in Z.  [theory §8]"""
        return [
            one.pull * self.cp.sum_squares(self.Z @ one.driven) - one.eased @ (self.Z @ one.driven)
            <= one.offset + wider * one.size
            for one in ([] if self.law is None else lagged_directions(self, self.law, self.shapes))
        ]

    def _scaled_inertia(self) -> Any:
        """S in coordinates where Mpp = I."""
        return np.eye(len(self.Mpp)) - self.columns.T @ self.Z @ self.columns

    def _scaled_stiffness(self) -> Array:
        """Kp in coordinates where Mpp = I, over `_frequency`^2."""
        base = np.linalg.cholesky(self.Mpp)
        scaled = np.linalg.solve(base, np.linalg.solve(base, self.Kp).T) / self._frequency**2
        return np.asarray(0.5 * (scaled + scaled.T))

    def _equality(self, beta: Any) -> list[Any]:
        return [self.rows @ self.Z @ self.columns == beta * self.goal]

    def _linear_map(self) -> tuple[Array, Array]:
        """V's entries, scaled, as a matrix on an orthonormal basis of the symmetric matrices; and that basis."""
        basis = symmetric_basis(len(self.B))
        return np.array([(self.rows @ matrix @ self.columns).ravel() for matrix in basis]).T, basis

    def _has_room(self, further: list[Any]) -> bool:
        """Whether the constraints hold strictly: the box is widened by the least that lets them hold, always solvable.

        Asking the solver for that number instead of a verdict keeps it away from infeasible programs.
        """
        wider = self.cp.Variable()
        least = self.solve(self.cp.Minimize(wider), [*self.widened(wider), *further])
        return least is not None and least < -ROOM

    def solve(self, objective: Any, constraints: list[Any]) -> float | None:
        """The optimal value; None where the constraints exclude each other. Raises Infeasible if Clarabel gives up."""
        return self.run(self.cp.Problem(objective, constraints))

    def run(self, problem: Any) -> float | None:
        """`solve` of a problem that was stated before.

        In cvxpy's own steps: its `solve` warns of inaccurate ends, process-wide; certificates judge the result itself.
        """
        try:
            data, chain, inverse = problem.get_problem_data(self.cp.CLARABEL, solver_opts={})
            found = chain.invert(chain.solve_via_data(problem, data, warm_start=True, solver_opts={}), inverse)
        except (self.cp.error.SolverError, ValueError) as fault:  # ValueError: numbers that overflow
            raise Infeasible(
                f"the solver Clarabel gave up at this pose ({fault}). Give another pose or another radius."
            ) from fault
        if found.status not in (*IMPOSSIBLE, *SOLVED):
            raise Infeasible(f"the solver Clarabel ended with {found.status}. Give another pose or another radius.")
        problem.unpack(found)
        return None if found.status in IMPOSSIBLE else float(problem.value)


def lagged_directions(program: MobilityProgram, law: LagLaw, shapes: Array) -> list[LaggedDirection]:
    """The delay law for shapes of any length, as columns, kept CLEAR by the share that a solver's rounding needs."""
    found = []
    for psi in shapes.T:
        driven, base = program.B @ psi, program.pose.arm.base
        r = float(relief(law, psi @ base.damping @ psi, psi @ base.stiffness @ psi))
        size = float(driven @ driven) / (1.0 + r)
        offset = r / (1.0 + r) * float(psi @ program.Mpp @ psi) - CLEAR * size
        found.append(LaggedDirection(driven, 1.0 / (1.0 + r), (1.0 - r) / (1.0 + r) * driven, offset, size))
    return found


def symmetric_basis(n: int) -> Array:
    """An orthonormal basis of the symmetric matrices, shape (n(n+1)/2, n, n)."""
    upper = np.column_stack(np.triu_indices(n))
    basis = np.zeros((len(upper), n, n))
    for matrix, (i, j) in zip(basis, upper, strict=True):
        matrix[i, j] = matrix[j, i] = 1.0 if i == j else np.sqrt(0.5)
    return basis


def least_change(lines: Array, missing: Array, basis: Array) -> Array:
    """The smallest symmetric matrix that supplies what equations, given on a basis, still miss."""
    return np.asarray(np.tensordot(np.linalg.lstsq(lines, missing, rcond=None)[0], basis, axes=1))
