"""`flexbase hardware-path`: verdicts on the loop as it runs, along a path of tips."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import Json
from flexbase.cli.options.loop import CompensatedLoopOptions
from flexbase.cli.options.pose import AnyElbow, Robot
from flexbase.cli.options.tips import tips_of
from flexbase.cli.terminal.out import OutFile, check_out
from flexbase.cli.terminal.progress import progress_bar
from flexbase.cli.terminal.show import show
from flexbase.plant import load
from flexbase.study.running.hardware_path import hardware_path as path_of

app = App(
    name="hardware-path",
    help_epilogue="""Examples:
  flexbase hardware-path ueda2003 --path tips.csv --method coprime
  flexbase hardware-path ueda2003 --path tips.csv --compensator E.json""",
)
Out = Annotated[OutFile, Parameter(help="write the verdicts as .json")]


@app.default
def hardware_path(
    robot: Robot,
    /,
    *,
    path: Annotated[Path, Parameter(metavar="FILE", help="tips, one a line (.csv) [m, rad]")],
    method: Annotated[str, Parameter(metavar="NAME", help="designed anew at every tip; none if left out")] = "none",
    elbow: AnyElbow = None,
    loop: CompensatedLoopOptions = CompensatedLoopOptions(),
    workers: Annotated[int | None, Parameter(metavar="N", help="processes; one a core if left out")] = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Stability, margins, changed robots and stiffness, each tip with a controller of its own."""
    check_out(out, (".json",))
    plant, tips = load(robot), tips_of(path)
    with progress_bar() as progress:
        found = path_of(plant, tips, method, loop=loop.loop(plant), branch=elbow, workers=workers, progress=progress)
    show("hardware-path", found, json, out)
