"""Verdicts on the loop as it runs along a path of tips."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from flexbase.checks import check_length
from flexbase.model.loop import Asked
from flexbase.plant import Plant
from flexbase.requests import Progress, no_progress
from flexbase.sampled.columns import below, cells, columns, legend
from flexbase.sheets.numbers import number
from flexbase.sheets.plain import Plain
from flexbase.sheets.sheet import Note, Sheet, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.study.running.hardware_map import BLOCK, MEASURES, judged_by, question_of
from flexbase.sweeps.cells.domain import Listed
from flexbase.sweeps.engine.runner import run
from flexbase.sweeps.engine.status import OK, VERDICTS
from flexbase.sweeps.requests import Execution


@dataclass(frozen=True)
class PathTip(Plain):
    """A tip [m, rad], what became of it in words, and the figures of its verdict; None where they have no meaning."""

    tip: tuple[float, ...]
    status: str
    figures: dict[str, float | None]

    document: ClassVar = ("tip", "status", "*figures")

    @property
    def place(self) -> str:
        """The tip in words."""
        return ", ".join(number(x, 4) for x in self.tip)


@dataclass(frozen=True)
class HardwarePath(Told):
    """Verdicts along a path.

    judged : what was judged at every tip, in words
    """

    robot: str
    judged: str
    tips: tuple[PathTip, ...]

    document: ClassVar = ("tips",)

    def sheet(self) -> Sheet:
        """A row a tip, with what became of it where it is not ok."""
        rows = [
            (one.place, one.status if one.status != VERDICTS[OK] else "", *cells(one.figures, MEASURES))
            for one in self.tips
        ]
        return make_sheet(
            self.robot,
            f"path of {self.judged}",
            table([words("tip"), words(""), *columns(MEASURES)], rows),
            below({one.place: one.figures for one in self.tips}, MEASURES),
            Note(f"{legend(MEASURES)}."),
        )


def hardware_path(
    plant: Plant,
    tips: Sequence[Sequence[float]],
    method: str = "none",
    *,
    loop: Asked = None,
    branch: str | None = None,
    workers: int | None = None,
    progress: Progress = no_progress,
) -> HardwarePath:
    """The verdicts of `hardware_map`, along a path of tips. Raises InputError."""
    question, meant = question_of(plant, method, loop, branch)
    targets = np.array([check_length("path", tip, plant.arm.k, "one for each task row") for tip in tips])
    found = run(question, Listed(targets), (BLOCK,), Execution(workers=workers), progress, {})
    status = [VERDICTS[code] for code in found["status"].values.tolist()]
    rows = np.array([found[name].values for name in MEASURES]).T.tolist()
    figures = [dict(zip(MEASURES, (None if v != v else v for v in row), strict=True)) for row in rows]
    told = tuple(map(PathTip, map(tuple, targets.tolist()), status, figures))
    return HardwarePath(plant.name, judged_by(method, meant), told)
