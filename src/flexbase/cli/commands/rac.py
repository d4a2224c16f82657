"""`flexbase rac`: the robust arm configurations, as curves or as points."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import CompensatorFile, Json, option
from flexbase.cli.options.pose import Robot, compensator_of
from flexbase.cli.options.values import Names, Vector, counts, names, numbers
from flexbase.cli.terminal.out import PICTURES, OutFile, check_out
from flexbase.cli.terminal.show import show
from flexbase.plant import load
from flexbase.study.robust_configurations.curves import RobustCurves, robust_curves
from flexbase.study.robust_configurations.points import COUNT, RobustPoints, robust_points

app = App(
    name="rac",
    help_epilogue="""Examples:
  flexbase rac ueda2003 --out rac.png
  flexbase rac ur5e-pedestal --modes 1 --count 5000 --out rac.csv
  flexbase rac iiwa-platform --json

With two task rows: curves over two joints. With more, or with --count: points,
all chosen modes positive real at once.""",
)
Out = Annotated[OutFile, Parameter(help="write a picture (.png .svg .pdf), .csv or .json")]


@app.default
def rac(
    robot: Robot,
    /,
    *,
    axes: Annotated[Names, option(names, "Q,Q", "curves: the two joints; elbow and the one before if left out")] = (),
    hold: Annotated[Vector, option(numbers, "NUMBERS", "curves: all arm joints, used where they do not vary")] = (),
    modes: Annotated[tuple[int, ...], option(counts, "N,N", "points: which modes, from 1; all if left out")] = (),
    count: Annotated[int | None, Parameter(metavar="N", help=f"points: how many samples; {COUNT} if left out")] = None,
    compensator: CompensatorFile = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Where the modes are positive real, every point to 1e-10."""
    check_out(out, (*PICTURES, ".csv", ".json"))
    plant = load(robot)
    used = compensator_of(plant, compensator)
    found: RobustCurves | RobustPoints
    if plant.arm.k == 2 and count is None and not modes:
        found = robust_curves(plant, axes, hold=hold, loop=used)
    else:
        found = robust_points(plant, modes or None, COUNT if count is None else count, loop=used)
    show("rac", found, json, out)
