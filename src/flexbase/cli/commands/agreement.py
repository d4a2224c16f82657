"""`flexbase agreement`: linear verdicts against their outcome in MuJoCo."""

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
from flexbase.study.agreement.study import TRIALS
from flexbase.study.agreement.study import agreement as agreement_of

app = App(
    name="agreement",
    help_epilogue="""Examples:
  flexbase agreement ueda2003 --poses 500 --json
  flexbase agreement ueda2003 --poses 500 --trial move
  flexbase agreement ueda2003 --poses 60 --methods none,coprime

Random controllers on random robots: each is nudged in MuJoCo and watched until
the motion has grown or died out. With --trial move it drives there from
elsewhere instead, through counts, noise and limits, and is pushed.

Exit status: 0 at least 98 % of the verdicts come true and neither error is
above 2 %, 1 not, 2 wrong input.""",
)
Out = Annotated[OutFile, Parameter(help="write all cases as .json")]


@app.default
def agreement(
    robot: Robot,
    /,
    *,
    poses: Annotated[int, Parameter(metavar="N", help="random poses, a controller each")] = 500,
    trial: Annotated[str, Parameter(help=f"how each is put to the test: {', '.join(TRIALS)}")] = "nudge",
    methods: Annotated[Names, option(names, "NAMES", "with commas; all if left out")] = (),
    seed: Annotated[int, Parameter(metavar="N", help="another seed, other poses and controllers")] = 0,
    workers: Annotated[int | None, Parameter(metavar="N", help="processes; one a core if left out")] = None,
    out: Out = None,
    json: Json = False,
) -> int:
    """Each linear verdict, stable or unstable, against settled or not on independent physics."""
    check_out(out, (".json",))
    plant = load(robot)
    with progress_bar(plain_lines=True) as report:
        found = agreement_of(
            plant, poses=poses, seed=seed, trial=trial, methods=methods or None, workers=workers, progress=report
        )
    show("agreement", found, json, out)
    return 0 if found.good else 1
