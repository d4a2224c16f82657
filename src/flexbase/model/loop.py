"""Which loop is meant around an arm: compensator, task gains and sensing, checked once, here, for every verb.

A verb takes a `Loop`, or a compensator alone, and asks `loop_on` for the `LoopSpec` on its arm.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np

from flexbase.cautions import caution
from flexbase.checks import LARGEST, Array, check_symmetric, check_within, finite_array
from flexbase.errors import InputError
from flexbase.model.mounted import MountedArm
from flexbase.model.sensing import TYPICAL, Sensing, checked_sensing
from flexbase.model.task import Gains, checked_gains


@runtime_checkable
class HasGain(Protocol):
    """Anything with a mode shaping matrix: a `Compensator`."""

    @property
    def E(self) -> Array:
        """Constant gain on the joint accelerations, shape (n, n)."""
        ...


class Gain(NamedTuple):
    """A bare mode shaping matrix."""

    E: Array


@dataclass(frozen=True, eq=False)
class Loop:
    """The loop as it is asked for. What is left out is the project's own, and no compensator.

    compensator : what `design` or `load_compensator` returned, or anything with a gain E
    gains : of the task-space law; sensing : how the loop really runs
    """

    compensator: HasGain | None = None
    gains: Gains | None = None
    sensing: Sensing | None = None


@dataclass(frozen=True, eq=False)
class LoopSpec:
    """The loop on one arm, checked. Made by `loop_on`.

    name : of the compensator's method, or what it is
    E : gain on the joint accelerations, exactly symmetric, shape (n, n), or None where none was given
    designed_at : arm joints that a compensator was designed at, shape (n,), or None
    given_gains : task gains, the project's own where none were given, or None where there are none at all
    sensing : as asked, as the project declares it, or 1 kHz with one sample of delay; `declared` says which
    """

    arm: MountedArm
    name: str
    E: Array | None
    designed_at: Array | None
    given_gains: Gains | None
    sensing: Sensing
    declared: bool

    @property
    def gains(self) -> Gains:
        """The task gains. Raises InputError where there are none."""
        if self.given_gains is None:
            raise InputError(
                f"{self.arm.name}: no task gains. Add a [control] table to the project, or give gains "
                "(--stiffness and --damping)."
            )
        return self.given_gains

    @cached_property
    def gain(self) -> Array:
        """E, or zero where there is none, shape (n, n)."""
        return np.zeros((self.arm.n, self.arm.n)) if self.E is None else self.E

    def check_bare(self) -> None:
        """Raises InputError where there is a compensator: a method that is asked for one brings its own."""
        if self.E is not None:
            raise InputError("method: a compensator is given too, and a method brings its own. Give one of them.")

    def scaled(self, scale: float) -> Gains:
        """Task gains (s Kp, sqrt(s) Kv): the same damping ratio at another stiffness. Raises InputError."""
        return Gains(scale * self.gains.stiffness, float(np.sqrt(scale)) * self.gains.damping)


Asked = Loop | HasGain | None  # how a verb's `loop` may be given


def loop_on(arm: MountedArm, asked: Asked = None) -> LoopSpec:
    """The loop on an arm. Warns where a compensator was designed for another robot. Raises InputError."""
    loop = asked if isinstance(asked, Loop) else Loop(asked)
    sensing = arm.sensing if loop.sensing is None else loop.sensing
    gains = arm.gains if loop.gains is None else checked_gains(loop.gains, arm.k)
    return LoopSpec(
        arm,
        "none" if loop.compensator is None else str(getattr(loop.compensator, "method", "compensator")),
        None if loop.compensator is None else gain_on(arm, loop.compensator),
        _designed_at(arm, loop.compensator),
        gains,
        checked_sensing(TYPICAL if sensing is None else sensing, arm.n),
        sensing is not None,
    )


def gain_on(arm: MountedArm, compensator: object) -> Array:
    """E of a compensator, finite and symmetric, of the arm's size. Raises InputError."""
    E = getattr(compensator, "E", None)
    if E is None:
        raise InputError(
            f"compensator: {type(compensator).__name__} has no gain E. Give what design or load_compensator returned."
        )
    given = finite_array("compensator E", E)
    if given.shape != (arm.n, arm.n):
        raise InputError(f"compensator: E has shape {given.shape}, but {arm.name} has {arm.n} arm joints.")
    made_for = getattr(compensator, "robot", arm.name)
    if made_for != arm.name:
        caution(f'compensator: designed for "{made_for}", used on "{arm.name}".')
    return check_symmetric("compensator E", check_within("compensator E", given, LARGEST, "kg m^2 or kg"), "")


def _designed_at(arm: MountedArm, compensator: object) -> Array | None:
    q = getattr(compensator, "q", None)
    return None if q is None or len(q) != arm.N else arm.parts.arm(np.asarray(q, dtype=float))
