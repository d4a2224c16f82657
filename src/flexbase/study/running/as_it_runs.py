"""An ideal compensator as it would run: the verdict that stands beside its certificate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from flexbase.model.loop import Asked, loop_on
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose, check_pose
from flexbase.sampled.controller import pd_with_gain
from flexbase.sampled.verdict import HardwareVerdict, hardware_verdict
from flexbase.sheets.sheet import Note, Sheet, facts, make_sheet
from flexbase.sheets.told import Told


@dataclass(frozen=True)
class AsItRuns(Told):
    """A compensator with task PD in the loop that a project declares, or in a typical one.

    declared : whether project or caller said how the loop runs
    """

    verdict: HardwareVerdict
    sensing: Sensing
    declared: bool

    document: ClassVar = ("declared", "sensing", "statement=verdict.statement", "*verdict")

    @property
    def good(self) -> bool:
        """Stable, with both disk margins, on the changed robots too."""
        return self.verdict.safe

    @property
    def loop(self) -> str:
        """The loop in a line, and whether it was assumed."""
        return self.sensing.summary() + ("" if self.declared else " (assumed: the project has no [sensing])")

    def sheet(self) -> Sheet:
        """Whether it runs, in which loop, and what to do where it does not."""
        mend = None if self.good else Note("flexbase compare compares what is made for this loop.")
        return make_sheet("As it runs", self.verdict.method, self.verdict.answer(), facts(("loop", self.loop)), mend)


def as_it_runs(pose: Pose, loop: Asked) -> AsItRuns | None:
    """The verdict on E with task PD at its pose, sampled; None without task gains.

    loop : the compensator, alone or with task gains and sensing that take the place of the project's own
    Raises InputError.
    """
    check_pose(pose)
    meant = loop_on(pose.arm, loop)
    if meant.given_gains is None:
        return None
    controller = pd_with_gain(pose, meant.sensing, meant.gains, meant.E, meant.name)
    return AsItRuns(hardware_verdict(controller), meant.sensing, meant.declared)
