"""What every design method hands back: its gain, judged by everything that the project knows about gains."""

from __future__ import annotations

import numpy as np

from flexbase.cautions import caution
from flexbase.checks import Array, is_definite
from flexbase.compensators.judge.lag_law import lag_limit
from flexbase.compensators.judge.why_positive_real import statement
from flexbase.control.compensator import Certificate, Compensator
from flexbase.errors import Infeasible
from flexbase.linear.linearise import is_reducible, modified_inertia
from flexbase.linear.margins import (
    algebraic_loop_radius,
    algebraic_loop_radius_per_joint,
    closed_loop_abscissa,
    lag_margin,
)
from flexbase.linear.modal import modes
from flexbase.model.loop import Asked, Gain, gain_on, loop_on
from flexbase.plant import Pose
from flexbase.sheets import units

NEARLY_SINGULAR = 0.01  # lambda_min(M - E) over that of M
MISSED = 1e-3  # relative miss of the targets that deserves a word


def certify(
    pose: Pose,
    method: str,
    E: Array,
    *,
    target_residual: float | None = None,
    loop: Asked = None,
    history: dict[str, Array] | None = None,
    cautions: tuple[str, ...] = (),
) -> Compensator:
    """A compensator with its certificate at `pose`. Assumes M - E > 0.

    target_residual : how far the method's own equations are from holding; None if the gain was not designed here
    loop : whose task gains close it; the project's own if left out
    cautions : the method's own; they take the place of the general one about missed targets
    Cautions when the algebraic loop does not bear a common delay.
    Raises Infeasible where M - E > 0 is lost to rounding.
    """
    E = gain_on(pose.arm, Gain(E))
    gains = loop_on(pose.arm, loop).given_gains
    if not is_definite(modified_inertia(pose, E), pose.M):
        raise Infeasible(f"{method}: what meets the targets leaves M - E no inertia in some direction. Ask for less.")
    before, after = modes(pose).modes, modes(pose, Gain(E)).modes
    rho, mu = algebraic_loop_radius(pose, E), algebraic_loop_radius_per_joint(pose, E)
    cautions = (
        *(cautions or _cautions_of_targets(target_residual)),
        *_cautions_of_loop(rho, mu),
        *_cautions_of_inertia(pose, E),
        *_cautions_of_arm(pose),
    )
    for text in cautions:
        caution(text)
    certificate = Certificate(
        min_eig_modified_inertia=float(np.linalg.eigvalsh(modified_inertia(pose, E))[0]),
        robustness_before=tuple(mode.robustness for mode in before),
        robustness_after=tuple(mode.robustness for mode in after),
        frequency_before_rad_s=tuple(mode.frequency for mode in before),
        frequency_after_rad_s=tuple(mode.frequency for mode in after),
        target_residual=target_residual,
        algebraic_loop_radius=rho,
        algebraic_loop_radius_per_joint=mu,
        lag_margin_s=None if gains is None else lag_margin(pose, E, gains),
        closed_loop_abscissa=None if gains is None else closed_loop_abscissa(pose, E, gains),
        lag_limit_s=lag_limit(pose, E),
        statement=statement(pose, E),
        warnings=cautions,
    )
    return Compensator(
        method, pose.plant.name, E, pose.q, certificate, history or {}, units.common("inertia", pose.arm.joint_units)
    )


def _cautions_of_targets(residual: float | None) -> tuple[str, ...]:
    if residual is None or residual <= MISSED:
        return ()
    return (
        f"the design misses its targets by {100.0 * residual:.2g} %: see robustness_after and frequency_after_rad_s.",
    )


def _cautions_of_loop(rho: float, mu: float) -> tuple[str, ...]:
    if rho >= 1.0:
        return (
            f"algebraic-loop radius {rho:.3f} is 1 or more: any delay in the measured acceleration, however small, "
            "destabilises this compensator. Method convex bounds it; exact, least-radius, makes it smallest.",
        )
    if mu >= 1.0:
        return (
            f"algebraic-loop radius {mu:.3f} with unequal delays is 1 or more: give all joints the same delay "
            f"(radius {rho:.3f}).",
        )
    return ()


def _cautions_of_arm(pose: Pose) -> tuple[str, ...]:
    arm, cautions = pose.arm, []
    if not is_reducible(pose):
        cautions.append(
            "gravity stiffness and joint friction are left out of the design equations; the certificate includes them."
        )
    if arm.n > arm.k:
        cautions.append(
            f"redundant arm: {arm.n - arm.k} self-motion{'s' * (arm.n - arm.k > 1)}, damped by a law of their own, "
            "left out of the closed loop's figures."
        )
    return tuple(cautions)


def _cautions_of_inertia(pose: Pose, E: Array) -> tuple[str, ...]:
    left, own = (float(np.linalg.eigvalsh(inertia)[0]) for inertia in (modified_inertia(pose, E), pose.M))
    if left >= NEARLY_SINGULAR * own:
        return ()
    return (f"M - E is nearly singular: {left:.2g} against {own:.2g} without E. Small model errors make it run away.",)
