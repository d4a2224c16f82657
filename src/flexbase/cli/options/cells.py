"""Where a map looks, which axes, how far, how fine, and what else varies; and how its cells are worked through."""

from __future__ import annotations

from cyclopts import Group

from flexbase.cli.options.from_request import from_request
from flexbase.cli.options.values import assignments, sign
from flexbase.study.montecarlo import Draws
from flexbase.sweeps import Cells, Execution

CELLS, EXECUTION = Group("Cells", sort_key=10), Group("Execution", sort_key=11)
BRANCH = {"branch": ("--elbow", "--branch")}


@from_request(CELLS, names=BRANCH, readers={"branch": sign})
class CellOptions(Cells):
    """Of a sweep."""


@from_request(CELLS, without=("branch", "vary", "sampling", "seed"))
class StudyCells(Cells):
    """Of a Monte Carlo study, whose pose has a branch already."""


@from_request(CELLS, names=BRANCH, readers={"branch": sign}, without=("over", "vary", "sampling", "seed"))
class TipCells(Cells):
    """Of a map over tips."""


@from_request(EXECUTION, without=("store",))
class ExecutionOptions(Execution):
    """Of a sweep; `--out` says where it is kept."""


@from_request(EXECUTION, without=("store", "resume"))
class StudyExecution(Execution):
    """Of a study in memory."""


@from_request(EXECUTION, without=("store", "engine"))
class VerdictExecution(Execution):
    """Of a map of verdicts."""


@from_request(CELLS, readers={"vary": lambda text, name: dict(assignments(text, name))})
class DrawOptions(Draws):
    """Of a Monte Carlo study."""
