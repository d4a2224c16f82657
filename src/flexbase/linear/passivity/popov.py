"""Where on the frequency axis a quadratic form of a response is singular: eigenvalues of a pencil, no grid."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from flexbase.checks import Array
from flexbase.linear.passivity.stable_part import Port


class Popov:
    """Candidates for the frequencies where Phi = [F; I]* [[Q, S], [S, R]] [F; I] is singular, Q, S, R multiples of I.

    They are the imaginary eigenvalues of N - lambda diag(I, I, 0), by QZ: a Hamiltonian matrix would need the inverse
    of a corner block that tends to zero.  [theory §5]
    States, time and response are brought to a common size first.
    """

    def __init__(self, port: Port, gain: float) -> None:
        self.time = (
            float(np.exp(np.mean(np.log(np.abs(poles[poles != 0.0]))))) if (poles := _poles(port)).any() else 1.0
        )
        self.gain = gain
        self.A = port.A / self.time
        left, right = float(np.linalg.norm(port.C)), float(np.linalg.norm(port.B))
        size = np.sqrt(left * right / (gain * self.time))
        self.B, self.C, self.D = port.B * (size / right), port.C * (size / left), port.D / gain

    def __call__(self, Q: float, S: float, R: float) -> Array:
        """Sorted positive frequencies [rad/s]: every singular one is among them to rounding, others may be too.

        Q, S, R : in units of the response as it is
        """
        Q, R = Q * self.gain, R / self.gain
        A, B, C, D = self.A, self.B, self.C, self.D
        x, k = B.shape
        star, eye = np.conj(C).T, np.eye(k)
        corner = R * eye + S * (D + D.T) + Q * (D.T @ D)
        N = np.block(
            [
                [A, np.zeros((x, x)), B],
                [-Q * (star @ C), -A.T, -star @ (Q * D + S * eye)],
                [(S * eye + Q * D.T) @ C, B.T, corner],
            ]
        )
        E = np.diag(np.concatenate([np.ones(2 * x), np.zeros(k)]))
        over, under = scipy.linalg.eigvals(N, E, homogeneous_eigvals=True)
        finite = np.abs(under) > 0.0
        omega = np.imag(over[finite] / under[finite])
        return np.unique(omega[np.isfinite(omega) & (omega > 0.0)]) * self.time


def _poles(port: Port) -> np.ndarray:
    return np.asarray(np.linalg.eigvals(port.A)) if len(port.A) else np.zeros(0)
