"""`flexbase hardware-study`: which controllers run, over the workspace, at several rates and gains."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import Json, option
from flexbase.cli.options.pose import Robot
from flexbase.cli.options.values import Names, names
from flexbase.cli.terminal.out import OutFile, check_out
from flexbase.cli.terminal.progress import progress_bar
from flexbase.cli.terminal.show import show
from flexbase.plant import load
from flexbase.study.running.hardware_study import hardware_study as hardware_study_of
from flexbase.synthesis import HARDWARE_METHODS

app = App(
    name="hardware-study",
    help_epilogue=f"""Examples:
  flexbase hardware-study ueda2003 --poses 400 --json
  flexbase hardware-study ur5e-pedestal --poses 100 --methods none,coprime

Methods: {", ".join(HARDWARE_METHODS)}.
Gain scale s stands for the project's gains as (s Kp, sqrt(s) Kv).""",
)
Out = Annotated[OutFile, Parameter(help="write the table as .json")]


@app.default
def hardware_study(
    robot: Robot,
    /,
    *,
    poses: Annotated[int, Parameter(metavar="N", help="random poses over the workspace")] = 400,
    methods: Annotated[Names, option(names, "NAMES", "with commas; all if left out")] = (),
    seed: Annotated[int, Parameter(metavar="N", help="another seed, other poses")] = 0,
    workers: Annotated[int | None, Parameter(metavar="N", help="processes; one a core if left out")] = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Shares of the workspace where each controller is stable, keeps its margins, and survives a changed robot."""
    check_out(out, (".json",))
    plant = load(robot)
    with progress_bar(plain_lines=True) as report:
        found = hardware_study_of(
            plant,
            poses=poses,
            seed=seed,
            methods=methods or None,
            workers=workers,
            progress=report,
        )
    show("hardware-study", found, json, out)
