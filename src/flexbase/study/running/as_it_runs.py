"""An ideal compensator as it would run: the verdict that stands beside its certificate."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from flexbase.model.loop import Asked, loop_on
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose, check_pose
from flexbase.sampled.controller import pd_with_gain
from flexbase.sampled.judged import GOOD_MARGIN
from flexbase.sampled.verdict import HardwareVerdict, hardware_verdict


@dataclass(frozen=True)
class AsItRuns:
    """A compensator with task PD in the loop that a project declares, or in a typical one.

    declared : whether project or caller said how the loop runs
    """

    verdict: HardwareVerdict
    sensing: Sensing
    declared: bool

    @property
    def good(self) -> bool:
        """Stable, with both disk margins, on the changed robots too."""
        return self.verdict.safe

    @property
    def statement(self) -> str:
        """The verdict in one sentence."""
        found = self.verdict
        if not found.stable:
            return f"unstable as it runs: spectral radius {found.spectral_radius:.4f} a sample"
        size = f"disk margin {found.smaller_margin:.2f}" + ("" if found.has_margin else f", below {GOOD_MARGIN:g}")
        changed = "survives changes of the robot" if found.survives else f"fails with {', '.join(found.failed)}"
        return f"stable as it runs, {size}; {changed}"

    @property
    def loop(self) -> str:
        """The loop in a line, and whether it was assumed."""
        return self.sensing.summary() + ("" if self.declared else " (assumed: the project has no [sensing])")

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        said = {"declared": self.declared, "sensing": asdict(self.sensing), "statement": self.statement}
        return {**said, **self.verdict.to_dict()}

    def summary(self) -> str:
        """Two lines."""
        return f"{self.statement}\n  {self.loop}"


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
