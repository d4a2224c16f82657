"""The central object: a linear second-order system, and its state space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexbase.checks import Array
from flexbase.errors import InputError, import_extra


class StateSpace(NamedTuple):
    """x' = A x + B u, y = C x + D u."""

    A: Array
    B: Array
    C: Array
    D: Array


def solved_at(where: np.ndarray, matrices: np.ndarray, B: Array) -> np.ndarray:
    """matrices^-1 B of a response at complex frequencies, shape (..., 1, 1). Raises InputError at a pole."""
    try:
        return np.linalg.solve(matrices, np.broadcast_to(B.astype(complex), (*matrices.shape[:-2], *B.shape)))
    except np.linalg.LinAlgError as fault:
        pole = where[np.linalg.slogdet(matrices).sign == 0.0].ravel()[:1]
        raise InputError(f"frequency: {pole} is a pole, where the response is infinite. Give another one.") from fault


@dataclass(frozen=True, eq=False)
class SecondOrder:
    """M q'' + D q' + K q = B f,  y = C q.  [U03 eq 3-4]

    M, D, K : shape (N, N), M positive definite, as `check_definite_inertia` and `verdict` see to
    B : shape (N, inputs); C : shape (outputs, N)
    joint_names, input_names, output_names : for labels and for the named signals of `to_control`
    """

    M: Array
    D: Array
    K: Array
    B: Array
    C: Array
    joint_names: tuple[str, ...]
    input_names: tuple[str, ...]
    output_names: tuple[str, ...]

    def transfer_function(self, s: ArrayLike) -> np.ndarray:
        """P(s) = C (M s^2 + D s + K)^-1 B at complex frequencies s, shape (..., outputs, inputs).

        Raises InputError at a pole, which an undamped mode has on the imaginary axis, a rigid motion at 0.
        """
        s = np.asarray(s, dtype=complex)[..., None, None]
        return np.asarray(self.C @ solved_at(s, self.M * s * s + self.D * s + self.K, self.B))

    def state_space(self) -> StateSpace:
        """State x = [q; q'], of order 2N."""
        N = len(self.M)
        zero, eye = np.zeros((N, N)), np.eye(N)
        lower = np.linalg.solve(self.M, np.hstack([-self.K, -self.D, self.B]))
        A = np.vstack([np.hstack([zero, eye]), lower[:, : 2 * N]])
        B = np.vstack([np.zeros_like(self.B), lower[:, 2 * N :]])
        C = np.hstack([self.C, np.zeros_like(self.C)])
        return StateSpace(A, B, C, np.zeros((len(self.C), self.B.shape[1])))

    def to_control(self) -> Any:
        """The same system as a `control.StateSpace` with named signals. Needs the extra "control"."""
        control = import_extra("control", "control")
        return control.ss(
            *self.state_space(),
            states=[*self.joint_names, *(f"{name}_rate" for name in self.joint_names)],
            inputs=list(self.input_names),
            outputs=list(self.output_names),
        )
