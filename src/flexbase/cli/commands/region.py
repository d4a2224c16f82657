"""`flexbase region`: where one controller, made for a pose, stays valid around it."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import Json, option
from flexbase.cli.options.loop import CompensatedLoopOptions
from flexbase.cli.options.pose import PoseOptions, Robot
from flexbase.cli.options.values import number
from flexbase.cli.terminal.out import Out, check_out
from flexbase.cli.terminal.progress import progress_bar
from flexbase.cli.terminal.show import show
from flexbase.plant import load
from flexbase.study.running.region import region as region_of
from flexbase.synthesis import HARDWARE_METHODS

app = App(
    name="region",
    help_epilogue=f"""Examples:
  flexbase region ueda2003 --tip 0.33,-0.25 --method constant --out region.png
  flexbase region ueda2003 --tip 0.33,-0.25 --compensator E.json

Methods: {", ".join(HARDWARE_METHODS)}.
The method's controller, or its E, is kept while the arm moves to other poses.""",
)


@app.default
def region(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),
    method: Annotated[str | None, Parameter(metavar="NAME", help="whose controller; none if left out")] = None,
    half_width: Annotated[float, option(number, "M", "of the region, 0.15 if left out [m or rad]")] = 0.15,
    loop: CompensatedLoopOptions = CompensatedLoopOptions(),
    out: Out = None,
    json: Json = False,
) -> None:
    """The cells around a pose in which its controller is stable, keeps its margins, and survives changed robots."""
    check_out(out)
    plant = load(robot)
    at, meant = pose.pose(plant), loop.loop(plant)
    with progress_bar() as progress:
        found = region_of(at, method, meant, half_width=half_width, progress=progress)
    show("region", found, json, out)
