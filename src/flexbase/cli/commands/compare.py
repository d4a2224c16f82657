"""`flexbase compare`: controllers for the loop as it runs, judged side by side at a pose."""

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
from flexbase.study.running.comparison import compare as compare_at
from flexbase.synthesis import HARDWARE_METHODS

app = App(
    name="compare",
    help_epilogue=f"""Examples:
  flexbase compare ueda2003 --tip 0.33,-0.25
  flexbase compare ueda2003 --tip 0.33,-0.25 --rate 4000 --method none,coprime

Methods: {", ".join(HARDWARE_METHODS)}.
The clock and the senses are the project's [sensing], or 1 kHz with one sample
of delay; options stand in for single keys.""",
)
Out = Annotated[OutFile, Parameter(help="write the verdicts as .json")]


@app.default
def compare(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),
    method: Annotated[Names, option(names, "NAMES", "with commas; all if left out", ("--method", "--methods"))] = (),
    loop: LoopOptions = LoopOptions(),
    out: Out = None,
    json: Json = False,
) -> None:
    """Every controller in the sampled loop: margins, changed robots, stiffness."""
    check_out(out, (".json",))
    plant = load(robot)
    with progress_bar() as progress:
        found = compare_at(pose.pose(plant), method or None, loop.loop(plant), progress)
    content = {"declared": loop.declared(plant), **found.to_dict()}
    write_out(out, "compare", found, content)
    say("compare", content, found.sheet(), json, out)
