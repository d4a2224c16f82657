"""`flexbase verdict`: the exact answer to whether a pose is positive real, and at which frequencies not."""

from __future__ import annotations

from math import inf
from typing import Annotated

from cyclopts import App
from rich.console import RenderableType

from flexbase.cli.options.common import CompensatorFile, Json, option
from flexbase.cli.options.pose import PoseOptions, Robot, compensator_of, where
from flexbase.cli.options.words import number as read_number
from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.out import Out, check_out, write_out, written
from flexbase.cli.terminal.show import facts, put, title
from flexbase.cli.terminal.show import verdict as said
from flexbase.linear.passivity.judge import verdict as verdict_of
from flexbase.linear.passivity.verdict import Verdict
from flexbase.plant import load
from flexbase.sheets.numbers import number

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
    pose: PoseOptions = PoseOptions(),  # noqa: B008
    compensator: CompensatorFile = None,
    bandwidth: Annotated[float | None, option(read_number, "W", "judge up to this frequency only [rad/s]")] = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Positive real or not, by how much, and at which frequencies; negative imaginary; passivity indices."""
    check_out(out)
    plant = load(robot)
    there, used = pose.pose(plant), compensator_of(plant, compensator)
    found = verdict_of(there, used, bandwidth)
    content = found.to_dict()
    write_out(out, "verdict", found, content)
    put(document("verdict", content)) if json else put(*_tables(found, used is not None), *written(out))


def _tables(found: Verdict, compensated: bool) -> list[RenderableType]:
    assert found.pose is not None
    rows: list[tuple[str, object]] = [("shortage", found.in_words())]
    if found.half_at:
        rows.append(("worst at", f"{number(found.worst_at, 6)} rad/s"))
        rows.append(("half of it", found.half_in_words()))
    if found.fails_at:
        rows.append(("fails", found.failing_in_words()))
    index = "open" if found.output_index is None else number(found.output_index, 6)
    if found.output_index == -inf:
        index = "none: no feedback of the velocity makes it passive"
    rows += [("negative imaginary", "yes" if found.negative_imaginary else "no"), ("output-passivity index", index)]
    scope = "" if found.bandwidth is None else f", up to {number(found.bandwidth, 6)} rad/s"
    heading = f"exact verdict {'with' if compensated else 'without'} compensator{scope}"
    answer = said(found.positive_real, "Positive real", "Not positive real", " ".join(found.caveats))
    return [title(found.pose.plant.name, heading), "", where(found.pose), "", facts(rows), "", answer]
