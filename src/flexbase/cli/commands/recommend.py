"""`flexbase recommend`: which controller to use at a pose, why, at what cost, and when the answer would change."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import Json
from flexbase.cli.options.gains import GainOptions
from flexbase.cli.options.pose import PoseOptions, Robot
from flexbase.cli.options.sensing import SensingOptions
from flexbase.cli.terminal.out import OutFile, check_out
from flexbase.cli.terminal.progress import progress_bar
from flexbase.cli.terminal.show import show
from flexbase.model.loop import Loop
from flexbase.plant import load
from flexbase.study.running.recommend import recommend

app = App(
    name="recommend",
    help_epilogue="""Examples:
  flexbase recommend ueda2003 --tip 0.33,-0.25
  flexbase recommend ur5e-platform --joints 0,-1.2,1.6,-0.4,1.5,0 --json

Exit status: 0 a controller runs, 1 none does, 2 wrong input.""",
)
Out = Annotated[OutFile, Parameter(help="write the answer as .json")]


@app.default
def recommend_controller(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),
    loop: GainOptions = GainOptions(),
    run: SensingOptions = SensingOptions(),
    out: Out = None,
    json: Json = False,
) -> int:
    """All methods judged as the loop really runs: rates, delays and sensors of [sensing], or 1 kHz and one sample."""
    check_out(out, (".json",))
    plant = load(robot)
    with progress_bar() as report:
        sensing = run.sensing(plant) if run.declared(plant) else None
        found = recommend(pose.pose(plant), loop=Loop(None, loop.gains(plant), sensing), workers=None, progress=report)
    show("recommend", found, json, out)
    return 0 if found.best else 1
