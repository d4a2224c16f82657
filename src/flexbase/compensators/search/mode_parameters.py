"""The paper's representative parameters [w_i, omega_i] as functions of E, and their exact derivatives."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexbase.checks import Array
from flexbase.errors import Infeasible
from flexbase.linear.linearise import ReducedArrays, reduced_arrays
from flexbase.linear.quadratic_eigenproblem import Pole, damped_poles
from flexbase.plant import Pose


class ModeParameters(NamedTuple):
    """phi_i = [w_i, omega_i] for each mode, shape (m, 2), |R_i|, shape (m,), and what they were computed from."""

    values: Array
    residue_sizes: Array
    reduced: ReducedArrays
    poles: list[Pole]


def mode_parameters(pose: Pose, E: Array) -> ModeParameters:
    """w_i and omega_i under a gain E, slowest mode first.  [U03 eq 12]

    Raises Infeasible if M - E is not positive definite or the base is overdamped.
    """
    arm = pose.arm
    X = pose.Mhat - E
    reduced = reduced_arrays(pose, E)
    if min(np.linalg.eigvalsh(X)[0], np.linalg.eigvalsh(reduced.S)[0]) <= 0.0:
        raise Infeasible("M - E is no longer positive definite.")
    poles = damped_poles(reduced.S, arm.base.damping, arm.base.stiffness)
    if len(poles) != arm.m or any(pole.value.imag == 0.0 for pole in poles):
        raise Infeasible("the base became overdamped: its modes no longer have a natural frequency.")
    residues = [_residue(reduced, pole) for pole in poles]
    values = [[np.linalg.eigvalsh(R + R.T)[0], abs(pole.value)] for R, pole in zip(residues, poles, strict=True)]
    return ModeParameters(np.array(values), np.linalg.norm(residues, axis=(1, 2)), reduced, poles)


def upper_triangle(E: Array) -> Array:
    """The design vector rho = [e_11, ..., e_1n, e_22, ..., e_nn].  [U03 §III B]"""
    return np.asarray(E[np.triu_indices(len(E))])


def symmetric(rho: Array, n: int) -> Array:
    """E from its design vector."""
    E = np.zeros((n, n))
    E[np.triu_indices(n)] = rho
    return np.asarray(E + np.triu(E, 1).T)


def parameter_slopes(pose: Pose, E: Array, here: ModeParameters) -> Array:
    """H_i = d[w_i, omega_i]/d rho, exact, shape (m, 2, n(n+1)/2).  [U03 eq 15]

    Each pole and shape is differentiated through the bordered system of its eigenvalue equation and its normalisation
    psi^T (2 l S + Dp) psi = 1; assumes distinct poles and w_i below the other eigenvalues of R_i + R_i^T.
    """
    m, n = pose.arm.m, pose.arm.n
    Y = np.linalg.inv(pose.Mhat - E)
    left, right = pose.Jv @ Y, Y @ pose.Map
    directions = [symmetric(unit, n) for unit in np.eye(n * (n + 1) // 2)]
    changes_of_V = [left @ dE @ right for dE in directions]  # d(X^-1) = X^-1 dE X^-1
    changes_of_S = [-right.T @ dE @ right for dE in directions]
    slopes = np.zeros((m, 2, len(directions)))
    for i, pole in enumerate(here.poles):
        for j, (dV, dS) in enumerate(zip(changes_of_V, changes_of_S, strict=True)):
            slopes[i, :, j] = _slope(pose, here.reduced, pole, dV, dS)
    return slopes


def _slope(pose: Pose, reduced: ReducedArrays, pole: Pole, dV: Array, dS: Array) -> tuple[float, float]:
    """Derivatives of w and omega of one mode along one direction of E."""
    damping, stiffness = pose.arm.base.damping, pose.arm.base.stiffness
    l, psi, S = pole.value, pole.shape, reduced.S
    tangent = 2.0 * l * S + damping
    border = tangent @ psi
    dl = -(l**2) * (psi @ dS @ psi)
    dZ = l**2 * dS + dl * tangent
    system = np.block([[l**2 * S + l * damping + stiffness, border[:, None]], [border[None, :], np.zeros((1, 1))]])
    known = np.append(-dZ @ psi, -(dl * (psi @ S @ psi) + l * (psi @ dS @ psi)))
    dpsi = np.linalg.solve(system, known)[:-1]
    out, into = reduced.U @ psi, reduced.V @ psi
    dout, dinto = -dV @ psi + reduced.U @ dpsi, dV @ psi + reduced.V @ dpsi
    dR = 2.0 * np.real(np.conj(dl) * np.outer(out, into) + np.conj(l) * (np.outer(dout, into) + np.outer(out, dinto)))
    R = _residue(reduced, pole)
    weakest = np.linalg.eigh(R + R.T)[1][:, 0]
    return 2.0 * float(weakest @ dR @ weakest), float(np.real(np.conj(l) * dl) / abs(l))


def _residue(reduced: ReducedArrays, pole: Pole) -> Array:
    """R_i = 2 Re(conj(l) U psi psi^T V^T).  [U03 eq 7, theory §3]"""
    return np.asarray(2.0 * np.real(np.conj(pole.value) * np.outer(reduced.U @ pole.shape, reduced.V @ pole.shape)))
