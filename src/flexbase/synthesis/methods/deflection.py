"""The compensator without accelerometers: the base's pull, computed from its deflection as the tip shows it.

The modified inertia needs no acceleration, since the base's own equation of motion gives it (an exact identity):
tau_a = (I - E Ms^-1)^-1 [tau~ + E Ms^-1 Map Mpp^-1 (Kp q_p + Dp q_p')],  q_p = Jp^+ (e - Jv dq_a).  [theory §8]
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexbase.cautions import collected
from flexbase.checks import Array, inverse
from flexbase.compensators.registry import design
from flexbase.errors import FlexbaseError, Infeasible
from flexbase.linear.discrete.affine_loop import AffineLoop
from flexbase.linear.discrete.system import Discrete, delay, series, side_by_side, static
from flexbase.model.loop import Gain, gain_on
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.sampled.closed import plant_at_one_rate, plants_in_a_period
from flexbase.sampled.controller import SampledController, pd_with_gain
from flexbase.sampled.judged import GOOD_MARGIN, Judged, robots_at
from flexbase.synthesis.methods.sampled import landscape
from flexbase.synthesis.registry import hardware_method
from flexbase.synthesis.search.minimax import Landscape, descend
from flexbase.synthesis.search.stiffest import best_of

SEEN = 1e-6  # smallest to largest singular value of Jp, below which the tip does not tell the base's deflection
SHARE = 0.4  # of the ideal design, where the second descent starts
FREE = "E: in some direction all of the arm's inertia on a free base, which needs endless torques. Give less."
LOOKS = 60  # of each descent


@hardware_method(
    "deflection", "the compensator from the base's deflection: no accelerometer, but an accurate Kp and Jp"
)
def deflection(pose: Pose, sensing: Sensing, gains: Gains, *, E: Array | None = None) -> SampledController:
    """Task PD and E without acceleration, E chosen for the sampled loop.

    The objective and the descent are those of `sampled`, over the entries of E, from none and from 0.4 times the ideal
    design; of both ends the stiffest accepted is taken. A slower task sensor counts as its mean delay.

    E : shape (n, n), symmetric; no search then
    Raises Infeasible where the tip does not show the base's deflection; InputError.
    """
    _check_seen(pose)
    if E is None:
        look, basis = search(pose, sensing, gains)
        tried = [np.tensordot(descend(look, start, LOOKS).x, basis, 1) for start in _starts(pose)]
    else:
        tried = [gain_on(pose.arm, Gain(E))]
    robots = robots_at(pose, sensing)
    found = [Judged(with_deflection(pose, sensing, gains, one), robots) for one in tried]
    return best_of(found, GOOD_MARGIN, pose)


def with_deflection(pose: Pose, sensing: Sensing, gains: Gains, E: Array) -> SampledController:
    """Task PD with an E that acts through the base's deflection. Raises Unsolvable where E = Ms."""
    eye = np.eye(len(E))
    gain = inverse(eye - E @ np.linalg.inv(pose.Ms), FREE)
    law = static(np.hstack([gain, gain - eye]), sensing.step)
    system = series(signals(pose, sensing, gains), law)
    return SampledController("deflection", pose, sensing, system, None, {"gain": E.tolist()})


def signals(pose: Pose, sensing: Sensing, gains: Gains) -> Discrete:
    """From measurements to the task PD's torques (n) and the base's pull on the arm (n).

    With G = (I - E Ms^-1)^-1 the torques are G times the first and G - I times the second.
    """
    n, h = pose.arm.n, sensing.step
    pull = pose.Map @ np.linalg.solve(pose.Mpp, np.hstack([pose.Kp, pose.Dp]))
    law = pd_with_gain(pose, sensing, gains, None, "deflection").system
    base = series(base_deflection(pose, sensing), static(np.asarray(pull), h))
    split = static(np.vstack([np.eye(pose.arm.k + 2 * n)] * 2), h)
    return series(split, side_by_side(law, base))


def base_deflection(pose: Pose, sensing: Sensing) -> Discrete:
    """q_p (m) and its rate by differences (m) from measurements (k + 2n); the joints wait for the late tip error."""
    n, k, m, h = pose.arm.n, pose.arm.k, pose.arm.m, sensing.step
    together = side_by_side(static(np.eye(k), h), delay(n, sensing.mean_task_delay, h), static(np.zeros((0, n)), h))
    q_p = np.linalg.pinv(pose.Jp) @ np.hstack([np.eye(k), -pose.Jv])
    eye = np.eye(m)
    rates = Discrete(np.zeros((m, m)), eye, np.vstack([0.0 * eye, -eye / h]), np.vstack([eye, eye / h]), h)
    return series(series(together, static(np.asarray(q_p), h)), rates)


def _check_seen(pose: Pose) -> None:
    m, k = pose.arm.m, pose.arm.k
    if m == 0:
        raise Infeasible(f"{pose.plant.name}: the base is rigid, so it has no deflection. Use none, or coprime.")
    sizes = np.linalg.svd(pose.Jp, compute_uv=False)
    if m > k or sizes[-1] <= SEEN * sizes[0]:
        raise Infeasible(
            f"{pose.plant.name}: {k} task rows do not show all {m} base joints (smallest singular value of Jp "
            f"{0.0 if m > k else sizes[-1]:.3g}). Give more task rows, or a method that needs no base deflection."
        )


def search(pose: Pose, sensing: Sensing, gains: Gains) -> tuple[Callable[[Array], Landscape], Array]:
    """The objective and its slopes at x, and what E = sum of x_i basis_i is made of, in units of Ms."""
    n, k = pose.arm.n, pose.arm.k
    Ms = pose.Ms
    Ls, eye = np.linalg.cholesky(Ms), np.eye(n)
    entries = np.array([np.outer(eye[i], eye[j]) for i, j in _pairs(n)])
    basis = Ls @ np.maximum(entries, entries.swapaxes(1, 2)) @ Ls.T
    plants = [plant.select(inputs=list(range(n))) for plant in plants_in_a_period(pose, sensing)]
    loop = AffineLoop(plants, plant_at_one_rate(pose, sensing), signals(pose, sensing, gains), tuple(range(k + n)))
    per_E = np.linalg.inv(Ms)

    def look(x: Array) -> Landscape:
        gain = inverse(eye - np.tensordot(x, basis, 1) @ per_E, FREE)
        slopes = gain @ basis @ (per_E @ gain)
        return landscape(loop, np.hstack([gain, gain - eye]), np.concatenate([slopes, slopes], axis=2))

    return look, basis


def _pairs(n: int) -> list[tuple[int, int]]:
    return [(i, j) for i in range(n) for j in range(i, n)]


def _starts(pose: Pose) -> list[Array]:
    """No E, and a share of the ideal design."""
    Ls, pairs = np.linalg.cholesky(pose.Ms), _pairs(pose.arm.n)
    share = SHARE * np.linalg.solve(Ls, np.linalg.solve(Ls, _ideal(pose)).T)
    return [np.zeros(len(pairs)), np.array([share[pair] for pair in pairs])]


def _ideal(pose: Pose) -> Array:
    """The design for ideal acceleration, or nothing where there is none."""
    with collected(quietly=True):  # its radius is no matter here: no acceleration is fed back
        try:
            return design(pose).E
        except FlexbaseError:
            return np.zeros((pose.arm.n, pose.arm.n))
