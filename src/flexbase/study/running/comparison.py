"""Controllers for one pose beside each other, each with its verdict."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from flexbase.cautions import collected
from flexbase.checks import choose
from flexbase.errors import Infeasible, InputError, MissingExtra
from flexbase.model.loop import Asked, loop_on
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose, check_pose
from flexbase.requests import Progress, no_progress
from flexbase.sampled.columns import below, cells, columns, legend
from flexbase.sampled.figures import FIGURES
from flexbase.sampled.judged import GOOD_MARGIN
from flexbase.sampled.verdict import HardwareVerdict, hardware_verdict
from flexbase.sheets.plain import Plain
from flexbase.sheets.sheet import Note, Sheet, facts, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.synthesis import HARDWARE_METHODS, controller_for

NO_TORQUE = (
    "A robot that takes positions only cannot run these laws: they are torques. It can run admittance, well below the "
    "bandwidth of its own position loop."
)


@dataclass(frozen=True)
class Contender(Plain):
    """A method's verdict, or why it has none."""

    method: str
    verdict: HardwareVerdict | None
    reason: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Those of the verdict, or the reason."""
        return {"method": self.method, "infeasible": self.reason} if self.verdict is None else self.verdict.to_dict()


@dataclass(frozen=True)
class Comparison(Told):
    """The verdicts of several methods at a pose."""

    robot: str
    sensing: Sensing
    contenders: tuple[Contender, ...]

    document: ClassVar = ("robot", "sensing", "methods=contenders")

    def sheet(self) -> Sheet:
        """A row a method, what the columns mean, what fails, and why some have no controller."""
        judged = [one.verdict for one in self.contenders if one.verdict is not None]
        rows = [[f"{one.method}{'*' if one.safe else ''}", *cells(one.figures, FIGURES)] for one in judged]
        failing = [(one.method, ", ".join(one.failed)) for one in judged if one.failed and one.stable]
        reasons = [(one.method, one.reason) for one in self.contenders if one.verdict is None]
        return make_sheet(
            self.robot,
            "as it runs",
            facts(("loop", self.sensing.summary())),
            table([words("method"), *columns(FIGURES)], rows),
            Note(
                f"* safe: stable, disk margins of {GOOD_MARGIN:g} at torques and sensors, and on all changed robots "
                f"stable. {legend(FIGURES)}."
            ),
            below({one.method: one.figures for one in judged}, FIGURES),
            facts(*failing, heading="fails when changed"),
            facts(*reasons, heading="no controller"),
            Note(NO_TORQUE),
        )


def compare(
    pose: Pose, methods: Sequence[str] | None = None, loop: Asked = None, progress: Progress = no_progress
) -> Comparison:
    """Every method's controller at a pose, judged. All registered methods if none are named.

    Raises InputError for an unknown method, and where gains are missing.
    """
    names = list(HARDWARE_METHODS if methods is None else methods)
    for name in names:
        choose("method", name, HARDWARE_METHODS)
    check_pose(pose)
    meant = loop_on(pose.arm, loop)
    contenders = []
    for done, name in enumerate(names):
        progress(name, done, len(names))
        contenders.append(_contender(pose, name, meant.sensing, meant.gains))
    return Comparison(pose.plant.name, meant.sensing, tuple(contenders))


def _contender(pose: Pose, name: str, sensing: Sensing, gains: Gains) -> Contender:
    try:
        with collected(quietly=True):  # of ideal designs; the verdict says it better
            return Contender(name, hardware_verdict(controller_for(pose, name, sensing, gains)))
    except (Infeasible, InputError, MissingExtra) as reason:
        return Contender(name, None, str(reason))
