"""Exact design of redundant arms: X t = y and Jv t = alpha Jp, the self-motion in t free to choose.  [theory §7]"""

from __future__ import annotations

import numpy as np
import scipy.linalg

from flexbase.checks import Array
from flexbase.compensators.judge.lag_law import LagLaw, relief, words
from flexbase.errors import Infeasible
from flexbase.plant import Pose

BORDER = 0.1  # distance of alpha from [-1, 0], where the mode would be lost to force or tip
ATTAINED = 1.0 - 1e-9  # square of the radius below which the best self-motion exists
EDGE = 1e-3  # share of a band that a default frequency keeps from its ends
UNDRIVEN = 1e-9  # cosine of y and t below which the self-motion does not drive the base
BISECTIONS = 60  # between the least radius and the least pumping


def motions(pose: Pose) -> Array:
    """The span of t: one z, and the arm's self-motions, as columns."""
    return np.column_stack([np.linalg.pinv(pose.Jv) @ pose.Jp[:, 0], _null_space(pose.Jv)])


def lagged_bands(pose: Pose, law: LagLaw) -> list[tuple[float, float]]:
    """Bands of natural frequencies in which a self-motion with alpha BORDER outside [-1, 0] obeys the law [rad/s].

    With sigma = y.t = Mpp - Kp/omega^2 the smallest t^T Mhat t for given (alpha, sigma) is a quadratic form Q, and the
    law Q - (1 - r) sigma <= r Mpp an ellipse; alpha cuts a piece off on either side, and sigma runs between the ends of
    that piece.  [theory §8]
    """
    base, motion = pose.arm.base, motions(pose)
    chosen = np.vstack([np.eye(motion.shape[1])[0], -motion.T @ pose.Map[:, 0]])  # alpha and sigma of a t
    if np.linalg.matrix_rank(chosen) < 2:
        return []
    inertia, stiffness = float(pose.Mpp[0, 0]), float(base.stiffness[0, 0])
    r = float(relief(law, base.damping[0, 0], stiffness))
    inverse = chosen @ np.linalg.solve(motion.T @ pose.Mhat @ motion, chosen.T)
    Q = np.linalg.inv(inverse)
    centre = 0.5 * (1.0 - r) * inverse[:, 1]
    size = float(np.sqrt(r * inertia + centre @ Q @ centre))
    reach = size * inverse[:, 1] / np.sqrt(inverse[1, 1])  # from the centre to the largest sigma
    bands = []
    for border, outer in ((BORDER, 1.0), (-1.0 - BORDER, -1.0)):
        line = np.array([Q[1, 1], 2.0 * border * Q[0, 1] - (1.0 - r), border**2 * Q[0, 0] - r * inertia])
        cut = float(line[1] ** 2 - 4.0 * line[0] * line[2])
        ends = []
        for sign in (-1.0, 1.0):
            tip = centre + sign * reach
            if outer * (tip[0] - border) >= 0.0:
                ends.append(float(tip[1]))
            elif cut >= 0.0:
                ends.append(float(-line[1] + sign * np.sqrt(cut)) / (2.0 * line[0]))
        if len(ends) == 2 and max(ends[0], 0.0) < min(ends[1], inertia):
            low, high = (np.sqrt(stiffness / (inertia - end)) for end in (max(ends[0], 0.0), ends[1]))
            bands.append((float(low), float(high)))
    return bands


def within(bands: list[tuple[float, float]], frequency: float) -> float:
    """The frequency, or the nearest one well inside a band where it is in none of them."""
    if not bands or any(low <= frequency <= high for low, high in bands):
        return frequency
    near = [min(max(frequency, low + EDGE * (high - low)), high - EDGE * (high - low)) for low, high in bands]
    return min(near, key=lambda other: abs(other - frequency))


def freest(pose: Pose, frequency: float, law: LagLaw | None) -> tuple[Array, float]:
    """t and alpha of the self-motion with the smallest radius: one eigenproblem.  [theory §7, §8]

    With sigma = Mpp - Kp/omega^2 = y.t, the radius of the best E with X t = y is |L^-1 (Mhat - y y^T / sigma) t| over
    |L^T t|, Ms = L L^T: homogeneous in t, which ranges over the span of one z and the arm's self-motions. alpha has to
    lie outside [-1, 0]; where the best t's does not, t is best on one of the borders, kept BORDER away.
    The delay law bounds t^T Mhat t, and so is one more quadratic form. Raises Infeasible.
    """
    Mhat, y = pose.Mhat, -pose.Map[:, 0]
    stiffness, damping = float(pose.arm.base.stiffness[0, 0]), float(pose.arm.base.damping[0, 0])
    inertia = float(pose.Mpp[0, 0] - stiffness / frequency**2)
    span, pump = motions(pose), None
    if law is not None:  # t^T Mhat t - sigma <= r (Mpp - sigma), homogeneous in t
        allowed = inertia + relief(law, damping, stiffness) * (pose.Mpp[0, 0] - inertia)
        pump = Mhat - allowed / inertia**2 * np.outer(y, y)
    driven, first = span.T @ y, np.eye(span.shape[1])[0]
    borders = [inertia * first - alpha * driven for alpha in (BORDER, -1.0 - BORDER)]
    for bases in ([span], [span @ _null_space(border[None, :]) for border in borders]):
        turn = Mhat - np.outer(y, y) / inertia
        found = [one for basis in bases if (one := _least_turned(pose, basis, turn, pump)) is not None]
        for _, t in sorted(found, key=lambda pair: pair[0]):
            scaled = t * (inertia / float(y @ t))
            alpha = float(np.linalg.lstsq(span, scaled, rcond=None)[0][0])
            if not -1.0 <= alpha <= 0.0:
                return scaled, alpha
    if law is not None:
        freest(pose, frequency, None)  # raises where it is not the lag that binds
        bands = ", ".join(f"{low:.4f} to {high:.4f}" for low, high in lagged_bands(pose, law))
        where = f"it can at {bands} rad/s" if bands else "nor does it at any other frequency"
        raise Infeasible(
            f"the lag binds: {words(law)}, and at {frequency:g} rad/s no self-motion of the arm aligns the mode and "
            f"obeys that; {where}. Ask for {'one of those' if bands else 'another pose'}, or for a smaller lag."
        )
    raise Infeasible(
        "no gain aligns the mode here: the arm's self-motion does not drive the base. Choose another pose."
    )


def _least_turned(pose: Pose, basis: Array, turn: Array, pump: Array | None) -> tuple[float, Array] | None:
    """The t in a subspace with the smallest |L^-1 turn t| / |L^T t|, and that ratio; None where y.t = 0 there.

    turn t = Ms t wherever y.t = 0, so 1 is only a limit, of ever larger self-motions (a low frequency). Then the t that
    drives the base most for its inertia is taken. Where that breaks t^T pump t <= 0, the best t that does not, or None.
    """
    Ms, y = pose.Ms, -pose.Map[:, 0]
    image, weight = turn @ basis, basis.T @ Ms @ basis
    square = image.T @ np.linalg.solve(Ms, image)
    values, vectors = scipy.linalg.eigh(square, weight)
    short = np.asarray(vectors[:, 0] if values[0] < ATTAINED else np.linalg.solve(weight, basis.T @ y), dtype=float)
    if pump is not None:
        least = _least_pumping(short, square, basis.T @ pump @ basis, weight)
        if least is None:
            return None
        short = least
    t = basis @ short
    if abs(float(y @ t)) <= UNDRIVEN * float(np.linalg.norm(y) * np.linalg.norm(t)):
        return None
    moved = turn @ t
    return float(np.sqrt(moved @ np.linalg.solve(Ms, moved) / (t @ Ms @ t))), t


def _least_pumping(start: Array, square: Array, pump: Array, weight: Array) -> Array | None:
    """The t of the smallest t^T square t / t^T weight t with t^T pump t <= 0: `start` if it is; None if none is.

    The multiplier of the constraint is bisected: along its way from 0 to infinity t^T pump t only falls.
    """
    if start @ pump @ start <= 0.0:
        return start
    best, low, high = None, 0.0, 1.0
    for share in (high, *([None] * BISECTIONS)):
        middle = 0.5 * (low + high) if share is None else share
        t = scipy.linalg.eigh((1.0 - middle) * square + middle * pump, weight)[1][:, 0]
        if t @ pump @ t <= 0.0:
            best, high = t, middle
        elif best is None:
            return None
        else:
            low = middle
    return best


def _null_space(A: Array) -> Array:
    """Orthonormal columns that A, of full row rank, maps to zero."""
    return np.asarray(np.linalg.svd(A)[2][len(A) :].T)
