"""`flexbase simulate-sampled`: the move by a controller as hardware would run it."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.commands.simulate import MOVE
from flexbase.cli.options.common import Json, option
from flexbase.cli.options.from_request import options_given
from flexbase.cli.options.loop import CompensatedLoopOptions
from flexbase.cli.options.move import SampledMoveOptions
from flexbase.cli.options.pose import Elbow, Robot, compensator_of, tip_pose
from flexbase.cli.options.sampled import SampledOptions
from flexbase.cli.options.values import Vector, numbers
from flexbase.cli.terminal.out import Out, check_out
from flexbase.cli.terminal.show import show
from flexbase.plant import load
from flexbase.simulation import simulate_sampled as run_of
from flexbase.synthesis.make import make_controller

app = App(
    name="simulate-sampled",
    help_epilogue="""Examples:
  flexbase simulate-sampled ueda2003 --from 0.33,0.25 --to 0.33,-0.25 \\
      --compensator E.json --rate 4000
  flexbase simulate-sampled ueda2003 --from 0.33,0.25 --to 0.33,-0.25 \\
      --method coprime --plant mujoco --disturb 50,0 --end 0.8

Held torques, delays, counts and noise, by the project's [sensing] or 1 kHz with
one sample of delay; options stand in for single keys.
Exit status: 0 settled, 1 did not settle, 2 wrong input.""",
)


@app.default
def simulate_sampled(
    robot: Robot,
    /,
    *,
    start: Annotated[Vector, option(numbers, "X,Y", "where the tip starts [m, rad]", name="--from", group=MOVE)],
    goal: Annotated[Vector, option(numbers, "X,Y", "where it settles [m, rad]", name="--to", group=MOVE)],
    elbow: Annotated[Elbow, Parameter(group=MOVE)] = None,
    move: SampledMoveOptions = SampledMoveOptions(),
    by: SampledOptions = SampledOptions(),
    loop: CompensatedLoopOptions = CompensatedLoopOptions(),
    out: Out = None,
    json: Json = False,
) -> int:
    """Joint tracking up to the switch, then the sampled controller, on the nonlinear model."""
    check_out(out)
    plant = load(robot)
    meant = loop.loop(plant)
    there = tip_pose(plant, "--to", goal, elbow, near=compensator_of(plant, loop.compensator))
    here = tip_pose(plant, "--from", start, elbow, near=there)
    controller = make_controller(there, by.method, meant, **options_given(by))
    found = run_of(controller, here, push=by.push(move), move=move)
    show("simulate-sampled", found, json, out)
    return 0 if found.settled else 1
