"""Will it run? The verdict on a sampled controller at a pose, as the sensing declares the loop.  [theory §10]"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flexbase.plant import Pose
from flexbase.sampled.changes import Changed
from flexbase.sampled.controller import SampledController
from flexbase.sampled.figures import FIGURES
from flexbase.sampled.judged import GOOD_MARGIN, SAFE, STABLE, UNSTABLE, Judged, judged


@dataclass(frozen=True)
class HardwareVerdict:
    """What a sampled loop does at a pose, and what it bears. Every figure of `FIGURES` is an attribute too.

    stable : spectral radius below 1
    survives : whether all of the changed robots are stable; failed : those that are not; worst_change : the worst one
    figures : name -> value; None where it has no meaning, or was left out of a brief verdict
    """

    method: str
    stable: bool
    survives: bool
    failed: tuple[str, ...]
    worst_change: str
    figures: dict[str, float | None]

    def __getattr__(self, name: str) -> float | None:
        if name in FIGURES and "figures" in vars(self):
            return self.figures[name]
        raise AttributeError(f"a verdict has no figure {name!r}: there are {', '.join(FIGURES)}")

    @property
    def smaller_margin(self) -> float:
        """The smaller one of both disk margins."""
        return min(self.figures["disk_margin_torque"] or 0.0, self.figures["disk_margin_sensor"] or 0.0)

    @property
    def has_margin(self) -> bool:
        """Whether both disk margins are good."""
        return self.smaller_margin >= GOOD_MARGIN

    @property
    def grade(self) -> int:
        """3: stable, with margins, for all changed robots; 2: with margins or for all of them; 1: stable; 0: not."""
        return STABLE + int(self.has_margin) + int(self.survives) if self.stable else UNSTABLE

    @property
    def safe(self) -> bool:
        """Stable, with good disk margins, and on all changed robots stable."""
        return self.grade == SAFE

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        said = {name: value for name, value in vars(self).items() if name != "figures"}
        return {**said, "failed": list(self.failed), **self.figures}

    def summary(self) -> str:
        """What a person needs, in four lines."""
        if not self.stable:
            return f"{self.method}: unstable as it runs, spectral radius {self.spectral_radius:.4f} a sample"
        delay = "" if self.delay_margin_s is None else f"further delay {1e3 * self.delay_margin_s:.3f} ms; "
        kept = "survives all changes of the robot" if self.survives else f"fails with {', '.join(self.failed)}"
        return (
            f"{self.method}: stable, time constant {1e3 * (self.time_constant_s or 0.0):.1f} ms\n"
            f"  disk margin {self.disk_margin_torque:.3f} at torques, {self.disk_margin_sensor:.3f} at sensors\n"
            f"  {delay}{kept}\n"
            f"  tip stiffness {self.tip_stiffness:.4g} N/m at rest, {self.dynamic_stiffness:.4g} N/m at worst; "
            f"corrects {100.0 * (self.tip_correction or 0.0):.0f} % of a tip error that the joints do not show"
        )


def hardware_verdict(
    controller: SampledController,
    pose: Pose | None = None,
    changes: Sequence[Changed] | None = None,
    *,
    brief: bool = False,
) -> HardwareVerdict:
    """The verdict on a controller at the pose it was made for, or at another one.

    changes : robots that differ from the model; `eight_changes` if left out
    brief : leave out what takes longest: delay and lag margins and the radii of the algebraic loop, None then
    """
    return verdict_of(judged(controller, pose, changes), brief=brief)


def verdict_of(found: Judged, *, brief: bool = False) -> HardwareVerdict:
    """A judged loop as a verdict: all figures, or the brief ones."""
    return HardwareVerdict(
        method=found.controller.name,
        stable=found.stable,
        survives=found.survives,
        failed=found.failed,
        worst_change=found.worst_change,
        figures={name: found.figure(name) if one.brief or not brief else None for name, one in FIGURES.items()},
    )
