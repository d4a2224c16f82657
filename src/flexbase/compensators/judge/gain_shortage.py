"""How much passivity a gain leaves missing: by modes, with exact slopes, and by the whole response.  [theory §4, §5]"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.linalg

from flexbase.checks import Array
from flexbase.linear.linearise import reduced_arrays
from flexbase.linear.passivity.passivity_index import input_index, largest_gain
from flexbase.linear.passivity.stable_part import compressed
from flexbase.linear.passivity.vibration import base_vibration
from flexbase.linear.reduced import robustness
from flexbase.model.loop import Gain
from flexbase.plant import Pose

LOST = 1e-10  # of a and b, the size of the smaller one below which it is rounding
UNDAMPED = 1e-4  # damping ratio below which a base counts as undamped
ASSUMED = 0.01  # damping ratio of the slowest mode, proportional to stiffness, that an undamped base is given instead
POSITIVE_REAL = 1e-6  # relative shortage up to which a gain counts as positive real: the accuracy of a descent


class ModalShortage(NamedTuple):
    """-sum_i w_i / (4 zeta_i omega_i) and its slopes with respect to the entries of V and of the symmetric S."""

    value: float
    slope_V: Array
    slope_S: Array


def working_damping(pose: Pose) -> Array:
    """The base's damping; where a mode has next to none, 1 % proportional damping is added.

    Without damping every shortage is infinite: the weights 1/(zeta omega) then only rank the modes.
    """
    base = pose.arm.base
    stiffness, shapes = scipy.linalg.eigh(base.stiffness, pose.Mpp)
    ratios = np.diag(shapes.T @ base.damping @ shapes) / (2.0 * np.sqrt(stiffness))
    if ratios.min() >= UNDAMPED:
        return base.damping
    return np.asarray(base.damping + 2.0 * ASSUMED / np.sqrt(stiffness[0]) * base.stiffness)


def modal_shortage(Jp: Array, V: Array, S: Array, damping: Array, stiffness: Array) -> ModalShortage:
    """Sum over the undamped modes of (|a||b| - a.b) / (2 phi^T Dp phi), a = (V - Jp) phi, b = V phi.  [theory §4, §7]

    Exact for one base joint and for proportional damping, close for light damping; it counts no reward where w_i > 0
    (one task row). Assumes S > 0 and distinct frequencies.
    """
    squares, shapes = scipy.linalg.eigh(stiffness, S)
    total, slope_V, slope_S = 0.0, np.zeros_like(V), np.zeros_like(S)
    for i, phi in enumerate(shapes.T):
        a, b, damped = (V - Jp) @ phi, V @ phi, float(phi @ damping @ phi)
        length_a, length_b = float(np.linalg.norm(a)), float(np.linalg.norm(b))
        if min(length_a, length_b) <= LOST * max(length_a, length_b):
            continue  # a mode that the tip cannot see or drive
        gap = a / length_a - b / length_b
        missing = 0.5 * length_a * length_b * float(gap @ gap) / (2.0 * damped)
        total += missing
        slope_a, slope_b = length_b * gap / (2.0 * damped), -length_a * gap / (2.0 * damped)
        slope_V += np.outer(slope_a + slope_b, phi)
        slope_phi = (V - Jp).T @ slope_a + V.T @ slope_b - 2.0 * missing / damped * damping @ phi
        turns = _turns(squares, i)
        mixing = shapes @ (turns * (shapes.T @ slope_phi))
        slope_S += 0.5 * (np.outer(mixing, phi) + np.outer(phi, mixing))
    return ModalShortage(total, slope_V, slope_S)


def _turns(squares: Array, i: int) -> Array:
    """d phi_i = sum_j turns_j phi_j (phi_j^T dS phi_i), from (Kp - mu S) phi = 0 and phi^T S phi = 1."""
    apart = squares - squares[i]
    close = np.abs(apart) <= 1e-12 * np.abs(squares[i])
    turns = np.where(close, 0.0, squares[i] / np.where(close, 1.0, apart))
    turns[i] = -0.5
    return turns


def relative_shortage(pose: Pose, E: Array) -> float:
    """max(0, -inf over omega of lambda_min of the Hermitian part of G - R0/s) over the largest |G - R0/s|.  [theory §5]

    Exact, by the whole response, at any damping; 0 where it is positive real. Assumes M - E > 0; leaves gravity
    stiffness and friction of the arm out; an undamped base is given `working_damping`.
    """
    port = compressed(base_vibration(pose, Gain(E), working_damping(pose)).force_to_velocity())
    gain = largest_gain(port).value
    return max(0.0, -input_index(port, gain).value / gain) if gain > 0.0 else 0.0


def target_residual(pose: Pose, E: Array) -> float:
    """How far a gain is from w_i = 0 in each undamped mode and from a positive real response, whichever is more.

    Each mode's -w_i / (2 |R_i|), with |R_i| as it is or as it was without the gain, whichever is larger.
    """
    after, before = _misses(pose, E), _misses(pose, np.zeros_like(E))
    sizes = np.maximum(after[1], before[1])
    modal = np.where(sizes > 0.0, 0.5 * after[0] / np.where(sizes > 0.0, sizes, 1.0), 0.0)
    return float(max(modal.max(), relative_shortage(pose, E)))


def _misses(pose: Pose, E: Array) -> tuple[Array, Array]:
    """max(0, -w_i) and |R_i| of the undamped modes, slowest first."""
    reduced = reduced_arrays(pose, E)
    shapes = scipy.linalg.eigh(pose.arm.base.stiffness, reduced.S)[1]
    pairs = [(tuple((-reduced.U @ phi).tolist()), tuple((reduced.V @ phi).tolist())) for phi in shapes.T]
    lengths = np.array([[np.linalg.norm(a), np.linalg.norm(b)] for a, b in pairs])
    seen = lengths.min(axis=1) > LOST * lengths.max(axis=1)
    return np.array([seen[i] * max(0.0, -float(robustness(*pair))) for i, pair in enumerate(pairs)]), lengths.prod(1)


def cautions_of_shortage(pose: Pose, E: Array) -> tuple[str, ...]:
    """What to say of a gain that leaves the plant not positive real."""
    missing, before = relative_shortage(pose, E), relative_shortage(pose, np.zeros_like(E))
    if missing <= POSITIVE_REAL:
        return ()
    return (
        f"not positive real: passivity lacks {100.0 * missing:.2g} % of the largest response, "
        f"{100.0 * before:.2g} % without E.",
    )
