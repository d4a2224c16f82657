"""What a plant lacks for a measure, and what its values leave out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexbase.cautions import caution
from flexbase.errors import InputError
from flexbase.measures import Measure
from flexbase.model.base import Base
from flexbase.plant import Plant


def check_measures(plant: Plant, chosen: Sequence[Measure], asker: str) -> None:
    """Raise InputError where a plant lacks what a measure needs, and warn of what its values leave out.

    asker : how warnings begin
    """
    arm = plant.arm
    if arm.has_gravity:
        caution(f"{asker}: {plant.name} has gravity; its sag and stiffness are left out.")
    if any(one.reads_modes for one in chosen) and not proportional(arm.base):
        caution(f"{asker}: the damping of {plant.name} couples the modes; values are those of the undamped base.")
    for one in chosen:
        if missing := one.needs(arm.m, arm.n, arm.k):
            raise InputError(
                f"measure {one.name}: {missing} needed, {plant.name} has {arm.m} base joints, {arm.n} arm joints and "
                f"{arm.k} task rows."
            )
        if one.slow and arm.gains is None:
            raise InputError(
                f"measure {one.name}: task gains needed, {plant.name} has none. Give [control] in its project file."
            )


def proportional(base: Base) -> bool:
    """Whether mode shapes are real in every configuration: no damping, one joint, or damping like the stiffness."""
    D, K = base.damping, base.stiffness
    if base.m <= 1 or not D.any():
        return True
    ratio = np.trace(D) / np.trace(K)
    return bool(np.abs(D - ratio * K).max() <= 1e-12 * np.abs(D).max())
