"""`flexbase robust-points`: robust arm configurations, as points."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import CompensatorFile, Json, option
from flexbase.cli.options.pose import Robot, compensator_of
from flexbase.cli.options.values import counts
from flexbase.cli.terminal.out import PICTURES, OutFile, check_out
from flexbase.cli.terminal.show import show
from flexbase.plant import load
from flexbase.study.robust_configurations.points import COUNT
from flexbase.study.robust_configurations.points import robust_points as points_of

app = App(
    name="robust-points",
    help_epilogue="""Examples:
  flexbase robust-points ur5e-pedestal --modes 1 --count 5000 --out points.csv
  flexbase robust-points iiwa-platform --json

Random configurations, each moved to the nearest where all chosen modes are
positive real at once.""",
)
Out = Annotated[OutFile, Parameter(help="write a picture (.png .svg .pdf), .csv or .json")]


@app.default
def robust_points(
    robot: Robot,
    /,
    *,
    modes: Annotated[tuple[int, ...], option(counts, "N,N", "which modes, from 1; all if left out")] = (),
    count: Annotated[int, Parameter(metavar="N", help=f"how many samples; {COUNT} if left out")] = COUNT,
    compensator: CompensatorFile = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Where the modes are positive real, every point to 1e-10."""
    check_out(out, (*PICTURES, ".csv", ".json"))
    plant = load(robot)
    found = points_of(plant, modes or None, count, loop=compensator_of(plant, compensator))
    show("robust-points", found, json, out)
