"""A second-order response taken apart: rigid motion, undamped modes, unstable ones, and the damped rest.  [theory §5]

In coordinates with M = I and K diagonal a mode with D phi = 0 is coupled to no other: it is an undamped mode, or at
frequency 0 a rigid motion, on top of the imaginary axis, and can be taken off without an error in the rest.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.linear.linearise import check_definite_inertia, is_reducible, linearise, reduced_arrays
from flexbase.linear.passivity.stable_part import Port
from flexbase.linear.second_order import SecondOrder
from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Pose

STILL = 1e-12  # of the largest omega^2: a softer motion has no spring
ALIKE = 1e-9  # relative difference of omega^2 up to which modes are one
UNDAMPED = 1e-10  # of the largest damping
LOSSLESS = 1e-12  # damping ratio below which a mode counts as undamped, whatever the others have
UNSEEN = 1e-12  # of the terms that cancel in it: an output or input shape that is rounding


class UndampedMode(NamedTuple):
    """R / (s^2 + omega^2) in P(s); R is the sum of all modes at this frequency, shape (k, k)."""

    frequency: float
    residue: Array


class Vibration(NamedTuple):
    """P(s) = R0/s^2 + sum of undamped modes + c (s^2 + D s + diag(squares))^-1 b.

    rigid : R0, shape (k, k)
    undamped : modes without damping, slowest first
    squares, damping, c, b : of the damped rest, shapes (p,), (p, p), (k, p), (p, k)
    falling : the fastest rate [1/s] at which a motion without stiffness of its own runs away; 0: none
    """

    rigid: Array
    undamped: tuple[UndampedMode, ...]
    squares: Array
    damping: Array
    c: Array
    b: Array
    falling: float

    def force_to_velocity(self) -> Port:
        """F = G - R0/s - undamped modes, G(s) = s P(s), in the energy's own coordinates, shape (k, k)."""
        held = self.squares > 0.0
        springs, p = np.sqrt(self.squares[held]), len(self.squares)
        fed = np.diag(np.sqrt(self.squares))[held]
        A = np.block([[np.zeros((len(springs), len(springs))), fed], [-fed.T, -self.damping]])
        B = np.vstack([np.zeros((len(springs), len(self.c))), self.b])
        C = np.hstack([np.zeros((len(self.c), len(springs))), self.c])

        def response(omega: Array) -> np.ndarray:
            w = np.where(np.asarray(omega) > 0.0, omega, 1.0)[..., None]
            reactance = np.eye(p) * (w - self.squares / w)[..., None, :]
            F = self.c @ np.linalg.solve(
                self.damping + 1j * reactance, np.broadcast_to(self.b + 0j, (*w.shape[:-1], *self.b.shape))
            )
            return np.where((np.asarray(omega) > 0.0)[..., None, None], F, self._at_rest())

        return Port(A, B, C, np.zeros((len(self.c), len(self.c))), response, len(self.c))

    def force_to_displacement(self) -> Port | None:
        """i (P - R0/s^2 - undamped modes); its Hermitian part is negative imaginariness. None: infinite at rest."""
        if np.any(self.squares <= 0.0):
            return None
        velocity, k = self.force_to_velocity(), len(self.c)
        C = 1j * np.hstack([self.c / np.sqrt(self.squares), np.zeros((k, len(self.squares)))])
        B = np.vstack([np.zeros((len(self.squares), k)), self.b])

        def response(omega: Array) -> np.ndarray:
            w = np.asarray(omega)[..., None]
            Z = 1j * w[..., None] * self.damping + np.eye(len(self.squares)) * (self.squares - w * w)[..., None, :]
            return 1j * (self.c @ np.linalg.solve(Z, np.broadcast_to(self.b + 0j, (*w.shape[:-1], *self.b.shape))))

        return Port(velocity.A, B, C, np.zeros((k, k)), response, k)

    def _at_rest(self) -> Array:
        """F(0): what moves against friction alone."""
        free = self.squares <= 0.0
        if not free.any():
            return np.zeros((len(self.c), len(self.c)))
        return np.asarray(self.c[:, free] @ np.linalg.solve(self.damping[np.ix_(free, free)], self.b[free]))


def vibration_of(pose: Pose, loop: Asked = None) -> Vibration:
    """The response from tip force to tip displacement of a pose, taken apart.

    By the reduced form where stiffness and damping act on the base alone, else by the full matrices.
    Raises InputError if M - E is indefinite.
    """
    if is_reducible(pose):
        return base_vibration(pose, loop)
    return vibration_of_system(linearise(pose, loop))


def base_vibration(pose: Pose, loop: Asked = None, damping: Array | None = None) -> Vibration:
    """The same with the stiffness and damping of the base alone, by the reduced form.  [theory §3]

    damping : instead of the base's own, shape (m, m)
    """
    E, base = loop_on(pose.arm, loop).gain, pose.arm.base
    check_definite_inertia(pose, E)
    reduced = reduced_arrays(pose, E)
    carried = np.abs(pose.Jv) @ np.abs(reduced.W)
    terms = np.abs(pose.Jp) + carried, carried.T
    own = base.damping if damping is None else damping
    found = take_apart(reduced.S, own, base.stiffness, -reduced.V.T, reduced.U, terms)
    return found._replace(rigid=found.rigid + reduced.R0)


def vibration_of_system(system: SecondOrder) -> Vibration:
    """The same of any second-order system."""
    return take_apart(system.M, system.D, system.K, system.B, system.C)


def take_apart(M: Array, D: Array, K: Array, B: Array, C: Array, terms: tuple[Array, Array] | None = None) -> Vibration:
    """`Vibration` of C (M s^2 + D s + K)^-1 B. Assumes M > 0, D >= 0 and K symmetric.

    terms : sizes of the terms that C and B are sums of, below whose rounding a shape counts as zero
    """
    squares, shapes = scipy.linalg.eigh(K, M)
    still = np.abs(squares) <= STILL * np.abs(squares).max(initial=0.0)
    squares = np.where(still, 0.0, squares)
    damping = shapes.T @ D @ shapes
    shapes, squares, lossless = _separated(shapes, squares, 0.5 * (damping + damping.T))
    damping = shapes.T @ D @ shapes
    sizes = (np.abs(C), np.abs(B)) if terms is None else terms
    c, b = C @ shapes, shapes.T @ B
    c = np.where(np.linalg.norm(c, axis=0) <= UNSEEN * np.linalg.norm(sizes[0] @ np.abs(shapes), axis=0), 0.0, c)
    small = np.linalg.norm(b, axis=1) <= UNSEEN * np.linalg.norm(np.abs(shapes).T @ sizes[1], axis=1)
    b = np.where(small[:, None], 0.0, b)
    rigid = lossless & (squares == 0.0)
    swinging, rest = lossless & (squares > 0.0), ~lossless
    falling = float(np.sqrt(max(0.0, -squares.min(initial=0.0))))
    undamped = tuple(
        UndampedMode(float(np.sqrt(squares[group[0]])), c[:, group] @ b[group])
        for group in _groups(squares, np.flatnonzero(swinging))
    )
    rest &= squares >= 0.0
    return Vibration(
        c[:, rigid] @ b[rigid], undamped, squares[rest], damping[np.ix_(rest, rest)], c[:, rest], b[rest], falling
    )


def _separated(shapes: Array, squares: Array, damping: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Shapes turned within equal frequencies so that each is damped or not, and which are not."""
    turned, lossless = shapes.copy(), np.zeros(len(squares), dtype=bool)
    largest, fastest = np.linalg.norm(damping, 2) if len(squares) else 0.0, np.sqrt(np.abs(squares).max(initial=0.0))
    for group in _groups(squares, np.arange(len(squares))):
        _, sizes, turn = np.linalg.svd(damping[:, group], full_matrices=True)
        turned[:, group] = shapes[:, group] @ turn.T
        own = np.sqrt(np.abs(squares[group]).max()) or fastest
        lossless[group] = sizes <= max(UNDAMPED * largest, LOSSLESS * own)
    return turned, squares, lossless


def _groups(squares: Array, members: np.ndarray) -> list[np.ndarray]:
    """Members with the same omega^2, to rounding; sorted."""
    found: list[list[int]] = []
    for i in members:
        if found and squares[i] - squares[found[-1][0]] <= ALIKE * abs(squares[i]):
            found[-1].append(int(i))
        else:
            found.append([int(i)])
    return [np.array(group) for group in found]
