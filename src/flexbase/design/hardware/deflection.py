"""The compensator without accelerometers: the base's pull, computed from its deflection as the tip shows it.

The modified inertia needs no acceleration, since the base's own equation of motion gives it (an exact identity):
tau_a = (I - E Ms^-1)^-1 [tau~ + E Ms^-1 Map Mpp^-1 (Kp q_p + Dp q_p')],  q_p = Jp^+ (e - Jv dq_a).  [theory §8]
"""

from __future__ import annotations

import warnings

import numpy as np
from scipy.optimize import minimize

from flexbase.checks import Array, check_symmetric, finite_array
from flexbase.control.hardware import GOOD_MARGIN
from flexbase.control.sampled_controller import SampledController, pd_with_gain
from flexbase.design.hardware.registry import hardware_method
from flexbase.design.hardware.stiffest import best_of
from flexbase.design.hardware.trial import Robots, Trial, robots_at
from flexbase.design.registry import design
from flexbase.errors import FlexbaseError, FlexbaseWarning, Infeasible, InputError
from flexbase.linear.discrete import Discrete, delay, parallel, series, side_by_side, static
from flexbase.linear.margins import arm_on_free_base
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose

SEEN = 1e-6  # smallest to largest singular value of Jp, below which the tip does not tell the base's deflection
ENOUGH = 0.6  # disk margin beyond which speed counts
EVALUATIONS = 60  # of each descent
WHOLE = 2  # joints up to which all entries of E are free; else a span of three matrices


@hardware_method(
    "deflection", "the compensator from the base's deflection: no accelerometer, but an accurate Kp and Jp"
)
def deflection(pose: Pose, sensing: Sensing, gains: Gains, *, E: Array | None = None) -> SampledController:
    """Task PD and E without acceleration, E chosen for the sampled loop by Nelder and Mead's search.

    Minimises -min(disk margin, 0.6) + 0.05 min(time constant / 50 ms, 3), or the spectral radius where the loop is
    unstable, over the entries of E (more than two joints: over a span of three matrices), from no E and from 0.4 times
    the ideal design. A slower task sensor counts as its mean delay.

    E : shape (n, n), symmetric; no search then
    Raises Infeasible where the tip does not show the base's deflection; InputError.
    """
    _check_seen(pose)
    robots = robots_at(pose, sensing)
    if E is not None:
        given = finite_array("E", E)
        if given.shape != (pose.arm.n, pose.arm.n):
            raise InputError(
                f"E: shape {given.shape} given, {(pose.arm.n, pose.arm.n)} needed, one row for each arm joint."
            )
        check_symmetric("E", given, "kg m^2 or kg")
        found = [Trial(with_deflection(pose, sensing, gains, given), robots)]
    else:
        basis, starts = _span(pose)
        found = [_descend(pose, sensing, gains, robots, basis, start) for start in starts]
    return best_of(found, GOOD_MARGIN, pose).controller


def with_deflection(pose: Pose, sensing: Sensing, gains: Gains, E: Array) -> SampledController:
    """Task PD with an E that acts through the base's deflection. Raises numpy.linalg.LinAlgError where E = Ms."""
    m = pose.arm.m
    felt = E @ np.linalg.inv(arm_on_free_base(pose))
    gain = np.asarray(np.linalg.inv(np.eye(len(E)) - felt))
    pull = np.asarray(felt @ pose.M[m:, :m] @ np.linalg.inv(pose.M[:m, :m]))
    law = pd_with_gain(pose, sensing, gains, None, "deflection").system
    base = series(
        base_deflection(pose, sensing), static(np.asarray(pull @ np.hstack([pose.K[:m, :m], pose.D[:m, :m]])), law.step)
    )
    system = series(parallel(law, base), static(gain, law.step))
    return SampledController("deflection", pose, sensing, system, None, {"gain": E.tolist()})


def base_deflection(pose: Pose, sensing: Sensing) -> Discrete:
    """q_p (m) and its rate by differences (m) from measurements (k + 2n); the joints wait for the late tip error."""
    n, k, m, h = pose.arm.n, pose.arm.k, pose.arm.m, sensing.step
    wait = sensing.task_delay + sensing.task_every // 2
    together = side_by_side(static(np.eye(k), h), delay(n, wait, h), static(np.zeros((0, n)), h))
    q_p = np.linalg.pinv(pose.J[:, :m]) @ np.hstack([np.eye(k), -pose.J[:, m:]])
    eye = np.eye(m)
    rates = Discrete(np.zeros((m, m)), eye, np.vstack([0.0 * eye, -eye / h]), np.vstack([eye, eye / h]), h)
    return series(series(together, static(np.asarray(q_p), h)), rates)


def _check_seen(pose: Pose) -> None:
    m, k = pose.arm.m, pose.arm.k
    sizes = np.linalg.svd(pose.J[:, :m], compute_uv=False)
    if m > k or sizes[-1] <= SEEN * sizes[0]:
        raise Infeasible(
            f"{pose.plant.name}: {k} task rows do not show all {m} base joints (smallest singular value of Jp "
            f"{0.0 if m > k else sizes[-1]:.3g}). Give more task rows, or a method that needs no base deflection."
        )


def _span(pose: Pose) -> tuple[list[Array], list[Array]]:
    """Matrices whose combinations E is sought in, of the size of Ms, and two starts."""
    Ms, n, m = arm_on_free_base(pose), pose.arm.n, pose.arm.m
    root = np.linalg.cholesky(Ms)
    ideal = _ideal(pose)
    if n <= WHOLE:
        pairs = [(i, j) for i in range(n) for j in range(i, n)]
        basis = [root @ _symmetric(n, i, j) @ root.T for i, j in pairs]
        share = np.linalg.solve(root, np.linalg.solve(root, ideal).T)
        return basis, [np.zeros(len(basis)), 0.4 * np.array([share[pair] for pair in pairs])]
    return [Ms, pose.M[m:, m:] - Ms, ideal], [np.zeros(3), np.array([0.0, 0.0, 0.4])]


def _symmetric(n: int, i: int, j: int) -> Array:
    one = np.zeros((n, n))
    one[i, j] = one[j, i] = 1.0
    return one


def _ideal(pose: Pose) -> Array:
    """The design for ideal acceleration, or nothing where there is none."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlexbaseWarning)  # its radius is no matter here: no acceleration is fed back
        try:
            return design(pose).E
        except FlexbaseError:
            return np.zeros((pose.arm.n, pose.arm.n))


def _descend(pose: Pose, sensing: Sensing, gains: Gains, robots: Robots, basis: list[Array], start: Array) -> Trial:
    best: list[tuple[float, Trial]] = []

    def value(x: Array) -> float:
        E = sum(weight * part for weight, part in zip(x, basis, strict=True))
        try:
            trial = Trial(with_deflection(pose, sensing, gains, np.asarray(E)), robots)
            size = _objective(trial, sensing.step)
        except np.linalg.LinAlgError:
            return 1e3
        if not best or size < best[0][0]:
            best[:] = [(size, trial)]
        return size

    simplex = np.vstack([start, start + 0.2 * np.eye(len(start))])
    minimize(value, start, method="Nelder-Mead", options={"maxfev": EVALUATIONS, "initial_simplex": simplex})
    return best[0][1]


def _objective(trial: Trial, step: float) -> float:
    if trial.radius >= 1.0:
        return 10.0 + trial.radius
    slow = -step / float(np.log(max(trial.radius, 1e-12)))
    return -min(trial.rough_margin, ENOUGH) + 0.05 * min(slow / 0.05, 3.0)
