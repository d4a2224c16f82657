"""The delay law: what a small lag of the measured acceleration does to the damping of the base.  [theory §8]

A lag T changes 2 zeta omega = psi^T Dp psi into psi^T Dp psi - T omega^2 phi_a^T E phi_a, phi_a = -Y Map psi: a late
positive E pumps the mode, a late negative one damps it. As a constraint the lag may take a share eta of the damping.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy.linalg

from flexbase.checks import Array, positive_number
from flexbase.errors import Infeasible, InputError
from flexbase.linear.linearise import reduced_arrays
from flexbase.plant import Pose

SHARE = 0.5  # of a mode's damping that the lag may take, if nothing else is said
LONGEST = 1.0  # [s]; a mode that bears more counts as one that no lag endangers
ROUNDING = 1e-9  # of the arm's own inertia along the motion: smaller pumping is none
CLEAR = 1e-6  # the same, that programs keep away from the law, so that a solver's rounding cannot cross it


class LagLaw(NamedTuple):
    """A constraint: T omega^2 phi_a^T E phi_a <= eta psi^T Dp psi in every mode.  [theory §8]

    lag : T, total lag of the acceleration feedback [s]
    share : eta, of the damping
    """

    lag: float
    share: float


class Pumping(NamedTuple):
    """One entry a mode, slowest first.

    shapes : psi of the undamped modes, psi^T S psi = 1, as columns
    gained : psi^T Dp psi, what the base takes out [1/s]
    lost : omega^2 phi_a^T E phi_a, what a second of lag puts in [1/s^2]; 0 where that is rounding
    """

    shapes: Array
    gained: Array
    lost: Array


def checked_law(lag: object, share: object) -> LagLaw | None:
    """The law of two options; None without a lag. Raises InputError."""
    if isinstance(share, bool) or not isinstance(share, int | float) or not 0.0 <= share <= 1.0:
        raise InputError(f"lag_share: {share!r} must be from 0 to 1. {SHARE:g} of the damping is the usual choice.")
    if lag is None and share != SHARE:
        raise InputError(f"lag_share: {share:g} says nothing without a lag. Give lag too, in s.")
    return None if lag is None else LagLaw(positive_number("lag", lag, "s"), float(share))


def pumping(pose: Pose, E: Array) -> Pumping:
    """Damping of the modes under E, and how fast a lag takes it. Assumes a compliant base and M - E > 0."""
    reduced, base, Mhat = reduced_arrays(pose, E), pose.arm.base, pose.Mhat
    squares, shapes = scipy.linalg.eigh(base.stiffness, reduced.S)
    follow = -reduced.W @ shapes  # phi_a
    form, size = (np.einsum("ij,ik,kj->j", follow, A, follow) for A in (E, Mhat))
    return Pumping(
        shapes,
        np.einsum("ij,ik,kj->j", shapes, base.damping, shapes),
        squares * np.where(np.abs(form) <= ROUNDING * size, 0.0, form),
    )


def lag_limit(pose: Pose, E: Array) -> float | None:
    """Smallest lag that takes all damping of a mode, by the delay law [s].  [theory §8]

    None where E takes none, or only beyond a second; 0 where it takes some from an undamped base. Without task loop and
    at first order: within some 4 zeta^2 of the change, to T of about 0.1 ms on the paper's arm; beyond, the law
    over-predicts what a lag does. Assumes modes further apart than their damping: closer ones mix under a lag, and one
    of them may be lost at half of this.
    """
    if pose.arm.m == 0:
        return None
    _, gained, lost = pumping(pose, E)
    shortest = min((float(one / other) for one, other in zip(gained, lost, strict=True) if other > 0.0), default=np.inf)
    return shortest if shortest <= LONGEST else None


def obeys(law: LagLaw | None, pose: Pose, E: Array) -> bool:
    """Whether every true mode keeps its share of the damping."""
    if law is None:
        return True
    _, gained, lost = pumping(pose, E)
    return bool(np.all(law.lag * lost <= law.share * gained * (1.0 + ROUNDING)))


def check_obeyed(law: LagLaw | None, pose: Pose, E: Array) -> None:
    """Raises Infeasible, with the mode that loses most, where a gain breaks the law."""
    if law is None or obeys(law, pose, E):
        return
    _, gained, lost = pumping(pose, E)
    worst = int(np.argmax(law.lag * lost - law.share * gained))
    raise Infeasible(
        f"the lag binds: {words(law)}, but takes {law.lag * lost[worst]:.4g} of {gained[worst]:.4g} 1/s from mode "
        f"{worst + 1}. Ask for a smaller lag, a larger share, or another pose."
    )


def words(law: LagLaw) -> str:
    """The law in a message."""
    return f"a lag of {1e3 * law.lag:.4g} ms may take {100.0 * law.share:.3g} % of the damping"


def relief(law: LagLaw, damping: Any, stiffness: Any) -> Any:
    """r = eta psi^T Dp psi / (T psi^T Kp psi) for shapes psi of any length; no unit.

    With omega^2 = psi^T Kp psi / psi^T S psi the law reads phi_a^T E phi_a <= r psi^T S psi, its frequency free.
    """
    return law.share * damping / (law.lag * stiffness)


def fastest(law: LagLaw, pose: Pose, cost: float) -> float:
    """Highest natural frequency of one aligned mode that obeys the law [rad/s].  [theory §8]

    Alignment fixes phi_a = t psi, X t = y, so phi_a^T E phi_a = (t^T Mhat t - u) psi^2 with u = y.t = Mpp - Kp/omega^2.
    Along one direction t^T Mhat t = cost u^2, so the law, cost u^2 - (1 - r) u <= r Mpp, holds up to its positive root.

    cost : (t^T Mhat t) / (y.t)^2, shape-free; above 1/Mpp
    """
    base, inertia = pose.arm.base, float(pose.Mpp[0, 0])
    r = float(relief(law, base.damping[0, 0], base.stiffness[0, 0]))
    root = float(np.sqrt((1.0 - r) ** 2 + 4.0 * cost * r * inertia))
    driven = (1.0 - r + root) / (2.0 * cost) if r < 1.0 else 2.0 * r * inertia / (r - 1.0 + root)
    return float(np.sqrt(base.stiffness[0, 0] / (inertia - driven)))
