"""Task-priority mode shaping for several base joints: the slowest mode first, the next in its null space.  [Y01]"""

from __future__ import annotations

from typing import Annotated

from flexbase.compensators.options import Iterations, Seed, Slopes, Step
from flexbase.compensators.registry import method
from flexbase.compensators.search.recursion import ITERATIONS, STEP, shape_recursively
from flexbase.control.compensator import Compensator
from flexbase.model.loop import Asked
from flexbase.plant import Pose
from flexbase.requests import Says


@method("task-priority", "any number of base joints: the recursion, slowest mode first, the next in its null space")
def task_priority(
    pose: Pose,
    *,
    natural_frequency: Annotated[
        tuple[float, ...] | float | None, Says("wanted of each mode, slowest first", unit="rad/s", written="W,W")
    ] = None,
    step: Step = STEP,
    iterations: Iterations = ITERATIONS,
    derivatives: Slopes = "exact",
    seed: Seed = 0,
    loop: Asked = None,
) -> Compensator:
    """Step every [w_i, omega_i] towards [0, target i] from E = 0, earlier modes taking priority.  [Y01, U03 §III B]

    Assumes an underdamped base with distinct frequencies; leaves gravity stiffness out of the equations. With m modes
    and n (n + 1)/2 entries of E the later targets may stay unmet; the certificate's `target_residual` says how far.

    natural_frequency : wanted omega_i [rad/s], slowest first; if left out, a twentieth above the present ones
        (a quarter for one base joint)
    step, iterations, derivatives, seed : as for `recursive`
    Raises Infeasible if M - E stops being positive definite on the way.
    """
    return shape_recursively(
        pose,
        "task-priority",
        natural_frequency,
        step=step,
        iterations=iterations,
        derivatives=derivatives,
        seed=seed,
        loop=loop,
    )
