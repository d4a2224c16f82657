"""What can be said for certain about a gain: aligned by one beta, by one a mode, or by the whole response.  [theory §7]

With U = (1 - beta_i) Jp and V = beta_i Jp on each undamped mode phi_i, G - R0/s is congruent to the inverse of
s S C + Dp C + Kp C / s with C = Phi diag(c) Phi^-1, c_i = beta_i / (beta_i - 1). S C and Kp C are symmetric, so only
the damping is left: positive real if d diag(c) + diag(c) d >= 0 with d = Phi^T Dp Phi, and then at every frequency.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg

from flexbase.checks import Array
from flexbase.compensators.judge.gain_shortage import POSITIVE_REAL, relative_shortage
from flexbase.linear.linearise import ReducedArrays, is_reducible, reduced_arrays
from flexbase.plant import Pose

ALIGNED = 1e-7  # |V phi - beta Jp phi| / |Jp phi|: robustness is half its square, far below rounding
ALIKE = 1e-7  # relative difference of betas that count as one
ROUNDING = 1e-9  # of the damping's largest eigenvalue, and of beta's distance from 0 or 1


def statement(pose: Pose, E: Array) -> str:
    """Why the plant is positive real with this gain, in plain words, or that it is not. Assumes M - E > 0."""
    scope = "" if is_reducible(pose) else ", gravity stiffness and joint friction left out"
    if pose.arm.m == 0:
        return f"positive real: the base is rigid{scope}"
    reduced, base = reduced_arrays(pose, E), pose.arm.base
    shapes = scipy.linalg.eigh(base.stiffness, reduced.S)[1]
    betas = _betas(pose.Jp @ shapes, reduced.V @ shapes)
    if betas is not None:
        if _one_beta(pose, reduced, betas):
            return f"positive real at any damping of the base: V = beta Jp, beta = {betas.mean():.4g}{scope}"
        if _bears(shapes.T @ base.damping @ shapes, betas):
            own = ", ".join(f"{beta:.4g}" for beta in betas)
            return f"positive real with this damping of the base: each mode aligned, beta = {own}{scope}"
    missing = relative_shortage(pose, E)
    if missing <= POSITIVE_REAL:
        return f"positive real with this damping of the base, by its whole response{scope}"
    return f"not positive real: passivity lacks {100.0 * missing:.2g} % of the largest response{scope}"


def _betas(moved: Array, driven: Array) -> Array | None:
    """beta_i of V phi_i = beta_i Jp phi_i, all outside (0, 1); None where a mode is not aligned."""
    sizes = np.sum(moved**2, axis=0)
    if sizes.min() <= 0.0:
        return None
    betas = np.sum(moved * driven, axis=0) / sizes
    apart = np.linalg.norm(driven - betas * moved, axis=0)
    if np.any(apart > ALIGNED * np.sqrt(sizes)) or np.any((betas > ROUNDING) & (betas < 1.0 - ROUNDING)):
        return None
    return np.asarray(betas)


def _one_beta(pose: Pose, reduced: ReducedArrays, betas: Array) -> bool:
    """Whether V = beta Jp as a whole."""
    beta, Jp = float(betas.mean()), pose.Jp
    same = float(np.ptp(betas)) <= ALIKE * max(1.0, abs(beta))
    return same and bool(np.linalg.norm(reduced.V - beta * Jp) <= ALIGNED * max(1.0, abs(beta)) * np.linalg.norm(Jp))


def _bears(modal: Array, betas: Array) -> bool:
    """d diag(c) + diag(c) d >= 0, with the rows scaled so that beta = 1, where c is infinite, does no harm."""
    c, other = np.abs(betas), np.abs(betas - 1.0)  # c_i = c / other, and both signs of the side cancel
    coupled = modal * (c[None, :] * other[:, None]) + modal * (c[:, None] * other[None, :])
    values = np.linalg.eigvalsh(coupled)
    return bool(values[0] >= -ROUNDING * np.abs(values).max())
