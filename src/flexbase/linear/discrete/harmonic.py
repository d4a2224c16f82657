"""Sampled systems whose matrices repeat: a period as one step, and their response over all frequencies that alias."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from flexbase.checks import Array
from flexbase.linear.discrete.system import Discrete


@dataclass(frozen=True, eq=False)
class Harmonic(Discrete):
    """A periodic system, lifted: inputs and outputs of all samples of a period at once, `step` is the period.

    samples : in a period; channels are ordered by sample
    """

    samples: int = 1

    def transfer_function(self, frequencies: Array) -> np.ndarray:
        """From components at omega + 2 pi i / period, i < samples, to such ones; omega up to pi / period [rad/s].

        A periodic system scatters a frequency into all that alias with it over a period; a time-invariant one has a
        response of its own to each, and is block-diagonal here. So a diagonal uncertainty of any dynamics is a diagonal
        matrix of independent numbers.
        """
        omega = np.asarray(frequencies, dtype=float)
        samples = np.arange(self.samples)
        turns = (omega[:, None] * self.step + 2.0 * np.pi * samples) / self.samples  # a sample, of each component
        wave = np.exp(-1j * turns[:, :, None] * samples) / np.sqrt(self.samples)
        seen, driven = (np.kron(wave, np.eye(size // self.samples)) for size in self.D.shape)
        return np.asarray(seen @ super().transfer_function(omega) @ driven.conj().swapaxes(-1, -2))


def periodic(steps: Sequence[Discrete]) -> Discrete:
    """Systems that take turns on the same states, sample by sample; a single one is itself."""
    if len(steps) == 1:
        return steps[0]
    order, inputs, outputs = steps[0].order, steps[0].B.shape[1], len(steps[0].C)
    A, B = np.eye(order), np.zeros((order, 0))
    C, D = np.zeros((0, order)), np.zeros((0, 0))
    for one in steps:
        C = np.vstack([C, one.C @ A])
        D = np.block([[D, np.zeros((len(D), inputs))], [one.C @ B, one.D]])
        A, B = one.A @ A, np.hstack([one.A @ B, one.B])
    assert D.shape == (len(steps) * outputs, len(steps) * inputs)
    return Harmonic(A, B, C, D, len(steps) * steps[0].step, len(steps))
