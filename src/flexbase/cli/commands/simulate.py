"""`flexbase simulate`: move the tip, then settle it."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Group, Parameter

from flexbase.cli.options.common import CompensatorFile, Json, option
from flexbase.cli.options.gains import GainOptions
from flexbase.cli.options.move import MoveOptions
from flexbase.cli.options.pose import Elbow, Robot, compensator_of, tip_pose
from flexbase.cli.options.values import Vector, numbers
from flexbase.cli.terminal.out import Out, check_out
from flexbase.cli.terminal.show import show
from flexbase.model.loop import Loop
from flexbase.plant import load
from flexbase.simulation import simulate as run_of

app = App(
    name="simulate",
    help_epilogue="""Examples:
  flexbase simulate ueda2003 --from 0.33,0.25 --to 0.33,-0.25
  flexbase simulate ueda2003 --from 0.33,0.25 --to 0.33,-0.25 \\
      --compensator E.json --out run.png

Settled: the tip comes below 0.1 mm after the switch and stays there.
Exit status: 0 settled, 1 did not settle, 2 wrong input.""",
)
MOVE = Group("Move", sort_key=10)


@app.default
def simulate(
    robot: Robot,
    /,
    *,
    start: Annotated[Vector, option(numbers, "X,Y", "where the tip starts [m, rad]", name="--from", group=MOVE)],
    goal: Annotated[Vector, option(numbers, "X,Y", "where it settles [m, rad]", name="--to", group=MOVE)],
    elbow: Annotated[Elbow, Parameter(group=MOVE)] = None,
    compensator: CompensatorFile = None,
    move: MoveOptions = MoveOptions(),
    gains: GainOptions = GainOptions(),
    out: Out = None,
    json: Json = False,
) -> int:
    """Joint tracking up to the switch, then the task-space loop, on the nonlinear model."""
    check_out(out)
    plant = load(robot)
    law = compensator_of(plant, compensator)
    there = tip_pose(plant, "--to", goal, elbow, near=law)
    here = tip_pose(plant, "--from", start, elbow, near=there)
    found = run_of(plant, here, there, Loop(law, gains.gains(plant)), move=move)
    show("simulate", found, json, out)
    return 0 if found.settled else 1
