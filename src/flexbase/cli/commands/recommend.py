"""`flexbase recommend`: which controller to use at a pose, why, at what cost, and when the answer would change."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import Json
from flexbase.cli.options.loop import LoopOptions
from flexbase.cli.options.pose import PoseOptions, Robot
from flexbase.cli.terminal.out import OutFile, check_out
from flexbase.cli.terminal.progress import progress_bar
from flexbase.cli.terminal.show import show
from flexbase.plant import load
from flexbase.study.running.recommend import recommend as recommend_at

app = App(
    name="recommend",
    help_epilogue="""Examples:
  flexbase recommend ueda2003 --tip 0.33,-0.25
  flexbase recommend ur5e-platform --joints 0,-1.2,1.6,-0.4,1.5,0 --json

Exit status: 0 a controller runs, 1 none does, 2 wrong input.""",
)
Out = Annotated[OutFile, Parameter(help="write the answer as .json")]


@app.default
def recommend(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),
    loop: LoopOptions = LoopOptions(),
    out: Out = None,
    json: Json = False,
) -> int:
    """All methods judged as the loop really runs: rates, delays and sensors of [sensing], or 1 kHz and one sample."""
    check_out(out, (".json",))
    plant = load(robot)
    with progress_bar() as report:
        found = recommend_at(pose.pose(plant), loop=loop.loop(plant), progress=report)
    show("recommend", found, json, out)
    return 0 if found.best else 1
