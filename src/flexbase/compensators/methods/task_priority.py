"""Task-priority mode shaping for several base joints: the slowest mode first, the next in its null space.  [Y01]"""

from __future__ import annotations

from collections.abc import Sequence

from flexbase.compensators.registry import method
from flexbase.compensators.search.recursion import ITERATIONS, STEP, shape_recursively
from flexbase.control.compensator import Compensator
from flexbase.model.task import Gains
from flexbase.plant import Pose


@method("task-priority", "any number of base joints: the recursion, slowest mode first, the next in its null space")
def task_priority(
    pose: Pose,
    *,
    natural_frequency: Sequence[float] | float | None = None,
    step: float = STEP,
    iterations: int = ITERATIONS,
    derivatives: str = "exact",
    seed: int = 0,
    gains: Gains | None = None,
) -> Compensator:
    """Step every [w_i, omega_i] towards [0, target i] from E = 0, earlier modes taking priority.  [Y01, U03 §III B]

    Assumes an underdamped base with distinct frequencies; leaves gravity stiffness out of the equations. With m modes
    and n (n + 1)/2 entries of E the later targets may stay unmet; the certificate's `target_residual` says how far.

    natural_frequency : wanted omega_i [rad/s], slowest first; if left out, a twentieth above the present ones
        (a quarter for one base joint)
    step, iterations, derivatives, seed : as for `recursive`
    Raises Infeasible if M - E stops being positive definite on the way.
    """
    targets = [natural_frequency] if isinstance(natural_frequency, int | float) else natural_frequency
    return shape_recursively(
        pose,
        "task-priority",
        targets,
        step=step,
        iterations=iterations,
        derivatives=derivatives,
        seed=seed,
        gains=gains,
    )
