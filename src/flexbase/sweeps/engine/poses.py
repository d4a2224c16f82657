"""A question that is asked pose by pose: what no formula says, such as a verdict on a controller made for the pose."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from flexbase.checks import Array, check_left_out
from flexbase.errors import SingularArm, Unreachable
from flexbase.plant import Plant, Pose
from flexbase.sweeps.engine.question import Block, Column
from flexbase.sweeps.engine.status import SINGULAR, UNREACHABLE, VERDICTS
from flexbase.sweeps.requests import Execution

Ask = Callable[[Pose], tuple[int, Sequence[float]]]


@dataclass(frozen=True, eq=False)
class EachPose:
    """Asked of the pose at every target of the tip, all k task rows.

    ask : a pose -> its status and a value for each column, or none at all where there is no value
    branch, near : as `Plant.at_tip` takes them
    """

    plant: Plant
    columns: tuple[Column, ...]
    ask: Ask
    branch: str | None = None
    near: Array | None = None
    recipe: Mapping[str, Any] = field(default_factory=dict)
    meanings: ClassVar[Mapping[int, str]] = VERDICTS
    threads: ClassVar[bool] = False

    def answer(self, inputs: Array) -> Block:
        """Status and values."""
        status = np.zeros(inputs.shape[1], dtype=np.int8)
        values = np.full((len(self.columns), len(status)), np.nan)
        for i, target in enumerate(inputs.T):
            try:
                pose = self.plant.at_tip(target, self.branch, near=self.near)
            except Unreachable:
                status[i] = UNREACHABLE
            except SingularArm:
                status[i] = SINGULAR
            else:
                status[i], found = self.ask(pose)
                values[: len(found), i] = found
        return Block({one.name: row for one, row in zip(self.columns, values, strict=True)}, status)


def by_processes(execution: Execution) -> Execution:
    """An execution that suits such a question, checked. Raises InputError."""
    check_left_out(Execution.checked(execution), ("engine",), "poses are asked one by one, by no engine. Leave it out.")
    return execution
