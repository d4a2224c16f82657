"""The paper's own law, sampled: task PD, without or with a compensator on measured accelerations."""

from __future__ import annotations

from functools import lru_cache

from flexbase.checks import Array
from flexbase.compensators import design
from flexbase.errors import Infeasible
from flexbase.linear.modal import modes
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.sampled.controller import SampledController, pd_with_gain
from flexbase.synthesis.registry import hardware_method

FASTER = 100.0  # rad/s above the present frequency: the target of the paper's Fig. 10


@hardware_method("none", "task PD alone", law="gains")
def none(pose: Pose, sensing: Sensing, gains: Gains) -> SampledController:
    """Task PD with the tip error differenced."""
    return pd_with_gain(pose, sensing, gains, None, "none")


@hardware_method("recursive", "the paper's 800 iterations on measured accelerations", law="gains")
def recursive(pose: Pose, sensing: Sensing, gains: Gains) -> SampledController:
    """Task PD with the recursion's E, 100 rad/s up. Raises Infeasible where it does not converge."""
    return pd_with_gain(pose, sensing, gains, _gain(pose, "recursive", _wanted(pose)), "recursive")


@hardware_method("exact", "the exact least gain on measured accelerations", law="gains")
def exact(pose: Pose, sensing: Sensing, gains: Gains) -> SampledController:
    """Task PD with the exact E at a frequency 100 rad/s up. Raises Infeasible where there is none."""
    return pd_with_gain(pose, sensing, gains, _gain(pose, "exact", _wanted(pose)), "exact")


@hardware_method(
    "convex", "the convex design's gain on measured accelerations, for any number of base joints", law="gains"
)
def convex(pose: Pose, sensing: Sensing, gains: Gains) -> SampledController:
    """Task PD with the E of the design method `convex`. Raises Infeasible where there is none."""
    return pd_with_gain(pose, sensing, gains, _gain(pose, "convex"), "convex")


@lru_cache(maxsize=24)
def _gain(pose: Pose, method: str, natural_frequency: float | None = None) -> Array:
    """E depends on the pose alone, and studies ask for it at several rates."""
    return design(pose, method, natural_frequency=natural_frequency).E


def _wanted(pose: Pose) -> float:
    if pose.arm.m == 0:
        raise Infeasible(f"{pose.plant.name}: the base is rigid, so there is no mode to shape. Use none.")
    return modes(pose)[0].frequency + FASTER
