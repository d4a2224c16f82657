"""`flexbase safe-gain`: how stiff may the task-space loop be with each controller?"""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import Json, option
from flexbase.cli.options.loop import LoopOptions
from flexbase.cli.options.pose import PoseOptions, Robot
from flexbase.cli.options.values import Names, names
from flexbase.cli.terminal.out import OutFile, check_out, write_out
from flexbase.cli.terminal.progress import progress_bar
from flexbase.cli.terminal.show import say
from flexbase.plant import load
from flexbase.study.running.safe_gain import safe_gain as safe_gain_of
from flexbase.study.running.safe_gain import sheet_of_gains
from flexbase.synthesis import HARDWARE_METHODS

app = App(
    name="safe-gain",
    help_epilogue=f"""Examples:
  flexbase safe-gain ueda2003 --tip 0.33,-0.25
  flexbase safe-gain ueda2003 --tip 0.33,-0.25 --rate 4000 --method none,viscous

Methods: {", ".join(HARDWARE_METHODS)}.
Each designs anew at every scale s of the gains (s Kp, sqrt(s) Kv). Safe: disk
margins of 0.3 at torques and sensors, and stable on all changed robots.""",
)
Out = Annotated[OutFile, Parameter(help="write the gains as .json")]


@app.default
def safe_gain(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),
    method: Annotated[Names, option(names, "NAMES", "with commas; none if left out", ("--method", "--methods"))] = (
        "none",
    ),
    loop: LoopOptions = LoopOptions(),
    out: Out = None,
    json: Json = False,
) -> None:
    """The highest gain at which a method's controller is safe, and at which it is merely stable."""
    check_out(out, (".json",))
    plant = load(robot)
    at, meant = pose.pose(plant), loop.loop(plant)
    found = []
    with progress_bar() as progress:
        for done, name in enumerate(method):
            progress(name, done, len(method))
            found.append(safe_gain_of(at, name, meant))
    content = {"declared": loop.declared(plant), "safe_gain": found}
    write_out(out, "safe-gain", found, content)
    say("safe-gain", content, sheet_of_gains(found), json, out)
