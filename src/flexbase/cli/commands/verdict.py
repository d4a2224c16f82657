"""`flexbase verdict`: the exact answer to whether a pose is positive real, and at which frequencies not."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App

from flexbase.cli.options.common import CompensatorFile, Json, option
from flexbase.cli.options.pose import PoseOptions, Robot, compensator_of
from flexbase.cli.options.values import number
from flexbase.cli.terminal.out import Out, check_out
from flexbase.cli.terminal.show import show
from flexbase.linear.passivity.judge import verdict as verdict_of
from flexbase.plant import load

app = App(
    name="verdict",
    help_epilogue="""Examples:
  flexbase verdict ueda2003 --tip 0.33,-0.25
  flexbase verdict ueda2003 --tip 0.33,-0.25 --compensator E.json --json
  flexbase verdict ueda2003 --tip 0.33,-0.25 --bandwidth 200 -o verdict.png

Not by modes but by the whole response, at any damping, without a frequency
grid. The status is 0 whatever the answer. Shortages without bound are null.""",
)


@app.default
def verdict(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),
    compensator: CompensatorFile = None,
    bandwidth: Annotated[float | None, option(number, "W", "judge up to this frequency only [rad/s]")] = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Positive real or not, by how much, and at which frequencies; negative imaginary; passivity indices."""
    check_out(out)
    plant = load(robot)
    show("verdict", verdict_of(pose.pose(plant), compensator_of(plant, compensator), bandwidth), json, out)
