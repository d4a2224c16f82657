"""Will it run? The verdict on a sampled controller at a pose, as the sensing declares the loop.  [theory §10]"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from flexbase.plant import Pose
from flexbase.sampled.changes import Changed
from flexbase.sampled.controller import SampledController
from flexbase.sampled.figures import FIGURES
from flexbase.sampled.judged import GOOD_MARGIN, SAFE, STABLE, UNSTABLE, Judged, judged
from flexbase.sheets.numbers import number
from flexbase.sheets.sheet import BAD, GOOD, Answer, Sheet, facts, make_sheet
from flexbase.sheets.told import Told


@dataclass(frozen=True)
class HardwareVerdict(Told):
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

    document: ClassVar = ("method", "stable", "survives", "failed", "worst_change", "*figures")

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

    @property
    def statement(self) -> str:
        """The verdict in one sentence."""
        if not self.stable:
            return f"unstable as it runs: spectral radius {self.spectral_radius:.4f} a sample"
        size = f"disk margin {self.smaller_margin:.2f}" + ("" if self.has_margin else f", below {GOOD_MARGIN:g}")
        changed = "survives changes of the robot" if self.survives else f"fails with {', '.join(self.failed)}"
        return f"stable as it runs, {size}; {changed}"

    def answer(self) -> Answer:
        """The sentence, good where the loop is safe."""
        return Answer(GOOD if self.safe else BAD, self.statement[0].upper() + self.statement[1:])

    def sheet(self) -> Sheet:
        """The sentence, and every figure that has a meaning."""
        told = [(one, self.figures[name]) for name, one in FIGURES.items() if self.figures.get(name) is not None]
        rows = [(one.words, f"{number(value, 6)} {one.unit}".removesuffix(" 1")) for one, value in told]
        return make_sheet(self.method, "as it runs", self.answer(), facts(*rows))


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
