"""Controllers for one pose beside each other, each with its verdict."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from flexbase.checks import choose
from flexbase.errors import FlexbaseWarning, Infeasible, InputError, MissingExtra
from flexbase.model.loop import Asked, loop_on
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose, check_pose
from flexbase.sampled.verdict import HardwareVerdict, hardware_verdict
from flexbase.synthesis import HARDWARE_METHODS, controller_for


@dataclass(frozen=True)
class Contender:
    """A method's verdict, or why it has none."""

    method: str
    verdict: HardwareVerdict | None
    reason: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return {"method": self.method, "infeasible": self.reason} if self.verdict is None else self.verdict.to_dict()


@dataclass(frozen=True)
class Comparison:
    """The verdicts of several methods at a pose."""

    robot: str
    sensing: Sensing
    contenders: tuple[Contender, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        methods = [one.to_dict() for one in self.contenders]
        return {"robot": self.robot, "sensing": asdict(self.sensing), "methods": methods}

    def summary(self) -> str:
        """A few lines a method."""
        said = [one.verdict.summary() if one.verdict else f"{one.method}: {one.reason}" for one in self.contenders]
        return "\n".join([f"{self.robot}, {self.sensing.summary()}", *said])


def compare(pose: Pose, methods: Sequence[str] | None = None, loop: Asked = None) -> Comparison:
    """Every method's controller at a pose, judged. All registered methods if none are named.

    Raises InputError for an unknown method, and where gains are missing.
    """
    names = list(HARDWARE_METHODS if methods is None else methods)
    for name in names:
        choose("method", name, HARDWARE_METHODS)
    check_pose(pose)
    meant = loop_on(pose.arm, loop)
    contenders = tuple(_contender(pose, name, meant.sensing, meant.gains) for name in names)
    return Comparison(pose.plant.name, meant.sensing, contenders)


def _contender(pose: Pose, name: str, sensing: Sensing, gains: Gains) -> Contender:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FlexbaseWarning)  # of ideal designs; the verdict says it better
            return Contender(name, hardware_verdict(controller_for(pose, name, sensing, gains)))
    except (Infeasible, InputError, MissingExtra) as reason:
        return Contender(name, None, str(reason))
