"""The paper's design for one base joint: 800 small steps with an estimated slope.  [U03 eq 12-16]"""

from __future__ import annotations

from flexbase.checks import positive_number
from flexbase.compensators.options import Iterations, Seed, Slopes, Step, Wanted
from flexbase.compensators.registry import method
from flexbase.compensators.search.recursion import ITERATIONS, STEP, shape_recursively
from flexbase.control.compensator import Compensator
from flexbase.errors import InputError
from flexbase.model.loop import Asked
from flexbase.plant import Pose


@method("recursive", "one base joint: the paper's 800-step recursion, slopes estimated or exact")
def recursive(
    pose: Pose,
    *,
    natural_frequency: Wanted = None,
    step: Step = STEP,
    iterations: Iterations = ITERATIONS,
    derivatives: Slopes = "estimated",
    seed: Seed = 0,
    loop: Asked = None,
) -> Compensator:
    """Step phi = [w_1, omega_1] towards [0, natural_frequency] from E = 0.  [U03 eq 12-16]

    Assumes one base joint, an underdamped base; leaves gravity stiffness out of the equations.

    natural_frequency : wanted omega_1 [rad/s]; a quarter above the present one if left out
    step : g1; derivatives : "estimated" (eq 16, from random variations drawn with `seed`) or "exact"
    Raises Infeasible if M - E stops being positive definite on the way.
    """
    if pose.arm.m > 1:
        raise InputError(
            f"recursive: {pose.arm.m} base joints, but this method shapes one; convex and task-priority shape several."
        )
    targets = None
    if natural_frequency is not None:
        targets = [positive_number("natural frequency", natural_frequency, "rad/s")]
    return shape_recursively(
        pose, "recursive", targets, step=step, iterations=iterations, derivatives=derivatives, seed=seed, loop=loop
    )
