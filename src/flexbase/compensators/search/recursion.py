"""The recursion that both of the paper's methods share: small steps towards the targets.  [U03 eq 13-16]"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from flexbase.checks import Array, check_length
from flexbase.compensators.judge.certificate import certify
from flexbase.compensators.search.mode_parameters import (
    ModeParameters,
    mode_parameters,
    parameter_slopes,
    symmetric,
    upper_triangle,
)
from flexbase.control.compensator import Compensator
from flexbase.errors import Infeasible, InputError
from flexbase.linear.linearise import modified_inertia
from flexbase.model.loop import Asked
from flexbase.plant import Pose

STEP = 0.02  # g1 of the paper's example
ITERATIONS = 800
RAISE = 1.25  # default target over the present frequency; the paper's example raises it by 1.2515
RAISE_SEVERAL = 1.05  # the same for several modes, which share one E
TRIAL = 1e-5  # size of the small variations from which H is estimated, relative to lambda_min(Mhat - E)
NEGLIGIBLE = 1e-9  # singular values of the first mode's scaled H below this are taken as zero
LEFT_OVER = 0.1  # the same for later modes: directions that earlier modes leave nearly no freedom in are given up
LOST = 0.5  # relative miss of the first mode's targets from which the answer is no
HALVINGS = 30  # of a step that would leave M - E > 0


def shape_recursively(
    pose: Pose,
    method: str,
    natural_frequencies: ArrayLike | None,
    *,
    step: float,
    iterations: int,
    derivatives: str,
    seed: int,
    loop: Asked,
) -> Compensator:
    """Drive [w_i, omega_i] towards [0, target] by repeated small steps in E, from E = 0; earlier modes take priority.

    Raises Infeasible, with the iteration, if M - E stops being positive definite or the first mode ends far off.
    """
    _check_options(pose, method, step, iterations, seed)
    now = first = mode_parameters(pose, np.zeros((pose.arm.n, pose.arm.n)))
    targets = np.zeros_like(now.values)
    targets[:, 1] = (RAISE if pose.arm.m == 1 else RAISE_SEVERAL) * now.values[:, 1]
    if natural_frequencies is not None:
        targets[:, 1] = check_length("natural frequency", natural_frequencies, pose.arm.m, "one for each mode")
    rng = np.random.default_rng(seed)
    n = pose.arm.n
    E, H = np.zeros((n, n)), np.zeros((pose.arm.m, 2, n * (n + 1) // 2))
    track = [_record(pose, E, now)]
    for iteration in range(iterations):
        try:
            H = parameter_slopes(pose, E, now) if derivatives == "exact" else _estimate(pose, E, now, H, rng)
            E, now = _advance(pose, E, _priority_step(H, step * (targets - now.values)))
        except Infeasible as fault:
            raise Infeasible(
                f"{method}: after {iteration} of {iterations} iterations {fault} Ask for other natural frequencies, "
                "a smaller step or another pose."
            ) from fault
        track.append(_record(pose, E, now))
    scale = np.column_stack([2.0 * first.residue_sizes, targets[:, 1]])  # theory §4's relative shortage
    missed = np.abs((now.values - targets) / np.where(scale > 0.0, scale, 1.0)).max(axis=1)
    if missed[0] > LOST:
        raise Infeasible(
            f"{method}: after {iterations} of {iterations} iterations the first mode misses its targets by "
            f"{missed[0]:.0%}. Ask for other natural frequencies or another pose."
        )
    history = dict(zip(("robustness", "frequency_rad_s", "min_eig_modified_inertia"), np.array(track).T, strict=True))
    return certify(pose, method, E, target_residual=float(missed.max()), loop=loop, history=history)


def _check_options(pose: Pose, method: str, step: float, iterations: int, seed: int) -> None:
    if pose.arm.m == 0:
        raise InputError(f"{method}: the base is rigid, so there is no mode to shape.")
    if not 0.0 < step <= 1.0:
        raise InputError(f"step: {step:g} must be above 0 and at most 1. The paper uses {STEP:g}.")
    if seed < 0:
        raise InputError(f"seed: {seed} must be 0 or more.")
    if iterations < 1:
        raise InputError(f"iterations: {iterations} must be 1 or more. The paper uses {ITERATIONS}.")


def _estimate(pose: Pose, E: Array, now: ModeParameters, H: Array, rng: np.random.Generator) -> Array:
    """H <- H + (Y - H X) X^+ from small random variations X of rho and the changes Y they cause.  [U03 eq 16]"""
    rho = upper_triangle(E)
    left = pose.Mhat - E
    size = TRIAL * float(np.linalg.eigvalsh(left)[0])
    X = size * rng.standard_normal((len(rho), len(rho)))
    moved = [mode_parameters(pose, symmetric(rho + variation, pose.arm.n)).values - now.values for variation in X.T]
    Y = np.moveaxis(np.array(moved), 0, -1)
    return np.asarray(H + (Y - H @ X) @ np.linalg.pinv(X))


def _priority_step(H: Array, wanted: Array) -> Array:
    """Change of rho that meets each mode's wanted change in the freedom that earlier modes leave.  [U03 eq 14, Y01]"""
    size = H.shape[-1]
    change, free = np.zeros(size), np.eye(size)
    for level, (slopes, aim) in enumerate(zip(H, wanted, strict=True)):
        lengths = np.linalg.norm(slopes, axis=1, keepdims=True)
        rows = 1.0 / np.where(lengths > 0.0, lengths, 1.0)
        inverse = np.linalg.pinv(rows * slopes @ free, rcond=LEFT_OVER if level else NEGLIGIBLE)
        change = change + inverse @ (rows[:, 0] * (aim - slopes @ change))
        free = free - inverse @ (rows * slopes @ free)
    return np.asarray(change)


def _advance(pose: Pose, E: Array, change: Array) -> tuple[Array, ModeParameters]:
    """The next E and its parameters; a step that would leave M - E > 0 is halved. Raises Infeasible if none is left."""
    for halving in range(HALVINGS):
        trial = symmetric(upper_triangle(E) + 0.5**halving * change, len(E))
        try:
            return trial, mode_parameters(pose, trial)
        except Infeasible as fault:
            refusal = fault
    raise refusal


def _record(pose: Pose, E: Array, now: ModeParameters) -> tuple[float, float, float]:
    """First mode's w and omega, and lambda_min(M - E): the three curves of the paper's Fig. 7."""
    return float(now.values[0, 0]), float(now.values[0, 1]), float(np.linalg.eigvalsh(modified_inertia(pose, E))[0])
