"""The algebraic loop: acceleration to torque through E, torque to acceleration through the arm on its free base."""

from __future__ import annotations

from flexbase.dynamics.inertia import arm_on_free_base
from flexbase.measures.registry import Configuration, measure
from flexbase.trace.algebra import Matrix, Scalar, absolute, larger
from flexbase.trace.eigen import generalised_eigen


@measure(
    "algebraic_loop_radius",
    unit="1",
    purpose="rho(Ms^-1 E) of the given gain: below 1 it survives a common delay",
    small_is_good=True,
)
def algebraic_loop_radius(configuration: Configuration) -> Scalar:
    """rho(Ms^-1 E), the gain once around the loop q'' -> torque -> q''; 0 without a compensator.  [theory §8]"""
    if configuration.E is None:
        return 0.0 * configuration.M[0][0]
    return loop_radius(configuration, configuration.E)


def loop_radius(configuration: Configuration, E: Matrix) -> Scalar:
    """rho(Ms^-1 E) of a symmetric E."""
    values = generalised_eigen(E, arm_on_free_base(configuration.M, configuration.parts)).values
    return larger(absolute(values[0]), absolute(values[-1]))
