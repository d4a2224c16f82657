"""`flexbase manipulability`: dynamic manipulability in both conventions."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.checks import choose
from flexbase.cli.options.common import CompensatorFile, Json
from flexbase.cli.options.pose import PoseOptions, Robot, compensator_of
from flexbase.cli.terminal.out import Out, check_out, write_out
from flexbase.cli.terminal.show import say
from flexbase.measures.manipulability import CONVENTIONS
from flexbase.measures.manipulability import manipulability as manipulability_of
from flexbase.plant import load
from flexbase.sheets.sheet import together

app = App(
    name="manipulability",
    help_epilogue="""Examples:
  flexbase manipulability ueda2003 --tip 0.33,-0.25
  flexbase manipulability ueda2003 --tip 0.33,-0.25 --compensator E.json
  flexbase manipulability ueda2003 --tip 0.33,-0.25 --convention torque -o e.svg

force: tip accelerations for |f| <= 1 (the paper's); torque: for |tau| <= 1.
A picture shows the convention asked for, or force.""",
)


@app.default
def manipulability(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),
    compensator: CompensatorFile = None,
    convention: Annotated[
        str | None, Parameter(metavar="NAME", help="show only force or torque; JSON holds both")
    ] = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Semi-axes and directions of the tip's acceleration, the base held still."""
    check_out(out)
    shown = CONVENTIONS if convention is None else (choose("--convention", convention, {n: n for n in CONVENTIONS}),)
    plant = load(robot)
    there, used = pose.pose(plant), compensator_of(plant, compensator)
    found = {name: manipulability_of(there, used, name) for name in CONVENTIONS}
    content = {"q": there.q, "tip": there.tip, **found}
    sheet = together(*(found[name].sheet() for name in shown))
    write_out(out, "manipulability", found[shown[0]], content)
    say("manipulability", content, sheet, json, out)
