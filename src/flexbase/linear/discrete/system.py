"""Sampled linear systems: exact zero-order hold, delays, connection, response."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from flexbase.checks import Array, inverse
from flexbase.errors import Unsolvable
from flexbase.linear.second_order import StateSpace, solved_at

ALGEBRAIC = (
    "loop: the torque of a sample would depend on itself, with gain 1 (an algebraic loop). Give a compute_delay, an "
    "accelerometer_lag or a smaller E."
)


@dataclass(frozen=True, eq=False)
class Discrete:
    """x[k+1] = A x[k] + B u[k], y[k] = C x[k] + D u[k], every `step` seconds.

    A : shape (states, states); B : (states, inputs); C : (outputs, states); D : (outputs, inputs)
    """

    A: Array
    B: Array
    C: Array
    D: Array
    step: float

    @property
    def order(self) -> int:
        """Number of states."""
        return len(self.A)

    def transfer_function(self, frequencies: Array) -> np.ndarray:
        """C (zI - A)^-1 B + D at z = exp(j omega step), shape (frequencies, outputs, inputs); omega in rad/s.

        Raises InputError at a pole on the unit circle.
        """
        z = np.exp(1j * np.asarray(frequencies) * self.step)[:, None, None]
        if not self.order:
            return np.broadcast_to(self.D.astype(complex), (len(z), *self.D.shape))
        return np.asarray(self.C @ solved_at(z, z * np.eye(self.order) - self.A, self.B) + self.D)

    def static_gain(self) -> Array:
        """Response to a constant input, after all has settled, shape (outputs, inputs). Assumes a stable system."""
        return np.asarray(self.C @ np.linalg.solve(np.eye(self.order) - self.A, self.B) + self.D)

    def select(self, outputs: list[int] | None = None, inputs: list[int] | None = None) -> Discrete:
        """The same system seen through some of its outputs and inputs."""
        rows = list(range(len(self.C))) if outputs is None else outputs
        columns = list(range(self.B.shape[1])) if inputs is None else inputs
        return Discrete(self.A, self.B[:, columns], self.C[rows], self.D[np.ix_(rows, columns)], self.step)


def hold(system: StateSpace, step: float) -> Discrete:
    """What a zero-order hold makes of a continuous system, exactly. Raises Unsolvable where it runs away in a step."""
    states, inputs = system.B.shape
    block = np.zeros((states + inputs, states + inputs))
    block[:states, :states], block[:states, states:] = system.A * step, system.B * step
    with np.errstate(over="ignore", invalid="ignore"):
        grown = scipy.linalg.expm(block)
    if not np.all(np.isfinite(grown)):
        raise Unsolvable(f"sensing: in a sample of {step:g} s the plant runs away. Give a higher rate.")
    return Discrete(grown[:states, :states], grown[:states, states:], system.C, system.D, step)


def static(D: Array, step: float) -> Discrete:
    """A gain without memory."""
    D = np.asarray(D, dtype=float)
    return Discrete(np.zeros((0, 0)), np.zeros((0, D.shape[1])), np.zeros((D.shape[0], 0)), D, step)


def delay(channels: int, samples: int, step: float) -> Discrete:
    """Every channel `samples` steps late."""
    if samples == 0:
        return static(np.eye(channels), step)
    size = channels * samples
    A = np.eye(size, k=-channels)
    B = np.eye(size, channels)
    return Discrete(A, B, np.eye(size)[size - channels :], np.zeros((channels, channels)), step)


def series(first: Discrete, then: Discrete) -> Discrete:
    """`then` after `first`."""
    return Discrete(
        np.block([[first.A, np.zeros((first.order, then.order))], [then.B @ first.C, then.A]]),
        np.vstack([first.B, then.B @ first.D]),
        np.hstack([then.D @ first.C, then.C]),
        then.D @ first.D,
        first.step,
    )


def side_by_side(*systems: Discrete) -> Discrete:
    """Systems with inputs and outputs of their own."""

    return Discrete(
        _diagonal([one.A for one in systems]),
        _diagonal([one.B for one in systems]),
        _diagonal([one.C for one in systems]),
        _diagonal([one.D for one in systems]),
        systems[0].step,
    )


def _diagonal(blocks: Sequence[Array]) -> Array:
    """Blocks along the diagonal; one without rows or columns still takes its columns or rows."""
    whole = np.zeros(np.sum([block.shape for block in blocks], axis=0))
    row = column = 0
    for block in blocks:
        height, width = block.shape
        whole[row : row + height, column : column + width] = block
        row, column = row + height, column + width
    return whole


def parallel(*systems: Discrete) -> Discrete:
    """The sum of systems that share their inputs."""
    both = side_by_side(*systems)
    inputs, outputs = systems[0].D.shape[1], systems[0].D.shape[0]
    spread = np.vstack([np.eye(inputs)] * len(systems))
    gathered = np.hstack([np.eye(outputs)] * len(systems))
    return Discrete(both.A, both.B @ spread, gathered @ both.C, gathered @ both.D @ spread, both.step)


def feedback(plant: Discrete, controller: Discrete, external: int = 0) -> Discrete:
    """The loop u = K y + d: from d, and the plant's last `external` inputs which the controller leaves alone, to y.

    Raises Unsolvable where the algebraic loop D_K D_P has an eigenvalue 1.
    """
    driven = plant.B.shape[1] - external
    Bu, Bw = plant.B[:, :driven], plant.B
    Du, Dw = plant.D[:, :driven], plant.D
    eye = np.eye(driven)
    loop = inverse(eye - controller.D @ Du, ALGEBRAIC)
    # u = loop (D_K (C x + D_w w) + C_K x_K) + first part of w, where w = [d; external]
    from_plant, from_controller = loop @ controller.D @ plant.C, loop @ controller.C
    from_w = loop @ controller.D @ Dw
    C = np.hstack([plant.C + Du @ from_plant, Du @ from_controller])
    D = Dw + Du @ from_w
    A = np.vstack([np.hstack([plant.A + Bu @ from_plant, Bu @ from_controller]), controller.B @ C])
    A[plant.order :, plant.order :] += controller.A
    B = np.vstack([Bw + Bu @ from_w, controller.B @ D])
    return Discrete(A, B, C, D, plant.step)


def spectral_radius(A: Array) -> float:
    """Largest absolute value of the eigenvalues: below 1, all dies out. Infinite for what has no finite entries."""
    if not np.all(np.isfinite(A)):
        return float(np.inf)
    return float(np.abs(np.linalg.eigvals(A)).max(initial=0.0))
