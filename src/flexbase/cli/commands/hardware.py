"""`flexbase hardware`: controllers for the loop as it runs, judged at a pose."""

from __future__ import annotations

from typing import Annotated, Any

from cyclopts import App, Parameter

from flexbase.cli.options.common import Json, option
from flexbase.cli.options.gains import GainOptions
from flexbase.cli.options.pose import PoseOptions, Robot
from flexbase.cli.options.sensing import SensingOptions
from flexbase.cli.options.values import Names, names, number
from flexbase.cli.terminal.out import OutFile, check_out, write_out
from flexbase.cli.terminal.progress import progress_bar
from flexbase.cli.terminal.show import say
from flexbase.errors import InputError
from flexbase.model.loop import Loop
from flexbase.plant import load
from flexbase.sheets.sheet import together
from flexbase.study.running.comparison import compare
from flexbase.study.running.region import region
from flexbase.study.running.safe_gain import safe_gain, sheet_of_gains
from flexbase.synthesis import HARDWARE_METHODS

app = App(
    name="hardware",
    help_epilogue=f"""Examples:
  flexbase hardware ueda2003 --tip 0.33,-0.25
  flexbase hardware ueda2003 --tip 0.33,-0.25 --rate 4000 --safe-gain
  flexbase hardware ueda2003 --tip 0.33,-0.25 --method constant --region -o r.png

Methods: {", ".join(HARDWARE_METHODS)}.
The clock and the senses are the project's [sensing], or 1 kHz with one sample
of delay; options stand in for single keys.""",
)
Out = Annotated[OutFile, Parameter(help="with --region: write a picture (.png .svg .pdf); else .json")]


@app.default
def hardware(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),  # noqa: B008
    method: Annotated[Names, option(names, "NAMES", "with commas; all if left out", ("--method", "--methods"))] = (),
    loop: GainOptions = GainOptions(),  # noqa: B008
    run: SensingOptions = SensingOptions(),  # noqa: B008
    safe_gain_: Annotated[bool, Parameter("--safe-gain", help="the highest safe gain with each method")] = False,
    region_: Annotated[bool, Parameter("--region", help="where the first method's controller stays valid")] = False,
    half_width: Annotated[float, option(number, "M", "of the region, 0.15 if left out [m or rad]")] = 0.15,
    out: Out = None,
    json: Json = False,
) -> None:
    """Every controller in the sampled loop: margins, changed robots, stiffness."""
    check_out(out, (".png", ".svg", ".pdf", ".json") if region_ else (".json",))
    if region_ and not method:
        raise InputError("--region: --method is missing. Say whose controller, such as --method constant.")
    plant = load(robot)
    meant, at = Loop(None, loop.gains(plant), run.sensing(plant)), pose.pose(plant)
    with progress_bar() as progress:
        found = compare(at, method or None, meant)
        content: dict[str, Any] = {"declared": run.declared(plant), **found.to_dict()}
        said, drawn = [found.sheet()], None
        if safe_gain_:
            scales = [safe_gain(at, one.method, meant) for one in found.contenders if one.verdict]
            content["safe_gain"] = scales
            said.append(sheet_of_gains(scales))
        if region_:
            drawn = region(at, method[0], meant, half_width=half_width, progress=progress)
            content["region"] = drawn
            said.append(drawn.sheet())
    write_out(out, "hardware", drawn, content)
    say("hardware", content, together(*said), json, out)
