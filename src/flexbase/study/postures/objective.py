"""What a search over postures makes large: a measure's values with their exact derivatives, many postures at once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from flexbase.checks import Array, choose
from flexbase.dynamics.inverse.posture_criteria import Criterion
from flexbase.dynamics.inverse.starts import spread_starts
from flexbase.errors import InputError
from flexbase.measures import MEASURES, Measure
from flexbase.model.loop import Asked, loop_on
from flexbase.model.mounted import MountedArm
from flexbase.plant import Plant, check_plant
from flexbase.sweeps.engine.formula import Formula
from flexbase.trace.kernel import Kernel, kernel_of

SHARPNESS = 20.0  # of the smooth minimum, over the spread of the values: it lies at most a twentieth of it too low
TYPICAL = 256  # postures from which the spread is taken


@dataclass(frozen=True, eq=False)
class Objective:
    """A measure of an arm, larger is better; of measures with a value for each mode, the worst mode's.

    Gravity's sag and stiffness and joint friction are left out, as in maps.

    E : a compensator's gain, n x n, or None
    """

    arm: MountedArm
    measure: Measure
    E: Array | None = None

    @property
    def sign(self) -> float:
        """-1 for measures of cost: their negative is made large."""
        return -1.0 if self.measure.small_is_good else 1.0

    @cached_property
    def kernel(self) -> Kernel:
        """Status and values, then the derivatives of each by the arm joints."""
        arm = self.arm
        question = Formula(arm, (self.measure,), tuple(range(arm.n)), (0.0,) * arm.n, E=self.E)
        return kernel_of(question, arm.n, f"posture\n{question.recipe}", derivative=True)

    def __call__(self, joints: Array) -> tuple[Array, Array]:
        """Signed values of each mode, shape (S, c), and their gradients, shape (S, c, n), of joints (S, n).

        c is m for measures of each mode, else 1. NaN where the arm is singular or the measure has no value.
        """
        S, n = joints.shape
        results = self.kernel(np.ascontiguousarray(joints.T))
        width = self.kernel.outputs // (n + 1)
        values, slopes = results[1:width], results[width:].reshape(width, n, S)[1:]
        return self.sign * values.T, self.sign * np.moveaxis(slopes, 2, 0)

    def worst(self, joints: Array) -> Array:
        """The smallest of each posture's values, shape (S,); -inf where there is none."""
        return np.asarray(np.nan_to_num(self(joints)[0].min(axis=1), nan=-np.inf))

    @cached_property
    def spread(self) -> float:
        """How much values differ between postures: the middle half of a sample, or one where all are equal."""
        values = self(spread_starts(self.arm.mechanism, self.arm.parts, "+", TYPICAL))[0]
        known = values[np.isfinite(values)]
        low, high = np.percentile(known, [25.0, 75.0]) if known.size else (0.0, 0.0)
        return float(high - low) or 1.0

    def smooth(self, sharpness: float = SHARPNESS) -> Criterion:
        """The smooth minimum -log(mean exp(-p v)) / p of the values with its gradient, p = sharpness / spread.

        Above the minimum by log(c) / p at most; the minimum itself where c = 1.
        """
        p = sharpness / self.spread

        def criterion(joints: Array) -> tuple[Array, Array]:
            values, slopes = self(joints)
            least = values.min(axis=1)
            weights = np.exp(-p * (values - least[:, None]))
            total = weights.sum(axis=1)
            smooth = least - np.log(total / values.shape[1]) / p
            return smooth, np.einsum("sc,scn->sn", weights / total[:, None], slopes)

        return criterion


def make_objective(plant: Plant, measure: str, loop: Asked) -> Objective:
    """The objective of a search, checked but for what the measure needs (`check_measures`). Raises InputError."""
    check_plant(plant)
    arm = plant.arm
    chosen = choose("measure", measure, MEASURES)
    if chosen.no_search is not None:
        raise InputError(f"measure {measure}: {chosen.no_search}. Give one of {', '.join(climbable())}.")
    if chosen.per_mode and arm.m == 0:
        raise InputError(f"measure {measure}: {plant.name} has a rigid base, no mode. Give manipulability.")
    return Objective(arm, chosen, loop_on(arm, loop).E)


def climbable() -> list[str]:
    """Measures that a search can make large."""
    return [name for name, one in MEASURES.items() if one.no_search is None]
