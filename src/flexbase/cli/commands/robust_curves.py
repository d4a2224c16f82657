"""`flexbase robust-curves`: the robust arm configurations over two joints, as curves."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import CompensatorFile, Json, option
from flexbase.cli.options.pose import Robot, compensator_of
from flexbase.cli.options.values import Names, Vector, names, numbers
from flexbase.cli.terminal.out import PICTURES, OutFile, check_out
from flexbase.cli.terminal.show import show
from flexbase.plant import load
from flexbase.study.robust_configurations.curves import robust_curves as curves_of

app = App(
    name="robust-curves",
    help_epilogue="""Examples:
  flexbase robust-curves ueda2003 --out curves.png
  flexbase robust-curves ueda2003 --compensator E.json --json

For arms with two task rows; robust-points serves all arms.""",
)
Out = Annotated[OutFile, Parameter(help="write a picture (.png .svg .pdf), .csv or .json")]


@app.default
def robust_curves(
    robot: Robot,
    /,
    *,
    axes: Annotated[Names, option(names, "Q,Q", "the two joints; elbow and the one before if left out")] = (),
    hold: Annotated[Vector, option(numbers, "NUMBERS", "all arm joints, used where they do not vary")] = (),
    compensator: CompensatorFile = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Where each mode is positive real, every point to 1e-10."""
    check_out(out, (*PICTURES, ".csv", ".json"))
    plant = load(robot)
    found = curves_of(plant, axes, hold=hold, loop=compensator_of(plant, compensator))
    show("robust-curves", found, json, out)
