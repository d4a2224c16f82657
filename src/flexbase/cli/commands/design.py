"""`flexbase design`: a compensator for one pose."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import Json
from flexbase.cli.options.from_request import options_given
from flexbase.cli.options.loop import LoopOptions
from flexbase.cli.options.method import MethodOptions
from flexbase.cli.options.pose import PoseOptions, Robot
from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.out import PICTURES, OutFile, check_out
from flexbase.cli.terminal.screen import put
from flexbase.cli.terminal.show import say
from flexbase.compensators import design as design_at
from flexbase.errors import Infeasible
from flexbase.plant import load
from flexbase.sheets.sheet import together
from flexbase.study.running.as_it_runs import as_it_runs

app = App(
    name="design",
    help_epilogue="""Examples:
  flexbase design ueda2003 --tip 0.33,-0.25 --natural-frequency 346.8
  flexbase design ueda2003 --tip 0.33,-0.25 --objective least-radius -o E.json
  flexbase design ueda2003 --tip 0.33,-0.25 --method recursive --seed 1

The file works with modes, simulate, manipulability and sweep: --compensator E.json
Exit status: 0 designed, 1 none exists (the reason is said), 2 wrong input.""",
)
Out = Annotated[OutFile, Parameter(help="write the compensator as JSON")]


@app.default
def design(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),
    by: MethodOptions = MethodOptions(),
    loop: LoopOptions = LoopOptions(),
    out: Out = None,
    json: Json = False,
) -> int:
    """Design E of tau = tau~ + E q'' at a pose: what it does by its certificate, and whether it would run."""
    is_picture = out is not None and out.suffix.lower() in PICTURES
    check_out(out, (".json",) if is_picture else ())  # it is JSON whatever its name
    plant = load(robot)
    meant = loop.loop(plant)
    try:
        at = pose.pose(plant)
        found = design_at(at, by.method, meant, **options_given(by))
    except Infeasible as reason:
        if not json:
            raise
        put(document("design", {"infeasible": str(reason)}))
        return 1
    if out is not None:
        found.save(out)
    real = as_it_runs(at, replace(meant, compensator=found))
    sheet = together(found.sheet(), *([] if real is None else [real.sheet()]))
    say("design", {**found.to_dict(), "as_it_runs": real}, sheet, json, out)
    return 0
