"""`flexbase layout`: where to put the work, or the base."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import CompensatorFile, Json, option
from flexbase.cli.options.pose import AnyElbow, Robot, compensator_of
from flexbase.cli.options.values import Names, names
from flexbase.cli.options.values import number as one_number
from flexbase.cli.terminal.out import Out, check_out
from flexbase.cli.terminal.show import show
from flexbase.plant import load
from flexbase.study.layout.best_layout import layout as layout_of
from flexbase.study.layout.targets import read_targets

app = App(
    name="layout",
    help_epilogue="""Examples:
  flexbase layout ueda2003 --targets job.csv
  flexbase layout ur5e-pedestal --targets job.csv --along x,y --turn
  flexbase layout ueda2003 --targets job.csv --within 0.1 --out layout.png

The file has a column for each task row, such as x,y,z, and if wanted one called
name. Joint limits and collisions are not looked at: bound the move by --within.
Exit status 1: some targets stay out of reach.""",
)


@app.default
def layout(
    robot: Robot,
    /,
    *,
    targets: Annotated[Path, Parameter(metavar="FILE", help="CSV of tip targets [m, rad]")],
    measure: Annotated[str, Parameter(metavar="NAME", help="what is made best; alignment if left out")] = "alignment",
    goal: Annotated[str, Parameter(metavar="NAME", help="worst (if left out) or mean over the targets")] = "worst",
    along: Annotated[Names | None, option(names, "X,Y", "axes of the move; all positions if left out")] = None,
    turn: Annotated[bool, Parameter(help="the work may also turn about the vertical")] = False,
    within: Annotated[float | None, option(one_number, "M", "largest move along an axis [m]; the reach")] = None,
    elbow: AnyElbow = None,
    compensator: CompensatorFile = None,
    out: Out = None,
    json: Json = False,
) -> int:
    """Move targets together to where the arm stands on them most robustly."""
    check_out(out)
    plant = load(robot)
    used = compensator_of(plant, compensator)
    given = read_targets(plant.arm.task, targets)
    found = layout_of(plant, given, measure, goal=goal, along=along, turn=turn, within=within, branch=elbow, loop=used)
    show("layout", found, json, out)
    return 1 if found.unreachable else 0
