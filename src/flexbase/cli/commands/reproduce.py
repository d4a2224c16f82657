"""`flexbase reproduce`: the paper, end to end."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import Json
from flexbase.cli.terminal.progress import progress_bar
from flexbase.cli.terminal.show import say

app = App(
    name="reproduce",
    help_epilogue="""Examples:
  flexbase reproduce
  flexbase reproduce --out paper --json

Writes fig05 to fig10, one file a panel, as PNG and SVG, with the numbers behind
each as CSV, and shows Table I and equation 17 beside what the paper prints.""",
)
Folder = Annotated[Path, Parameter(name=["--out", "-o"], metavar="FOLDER", help="where the figures go, out/paper")]


@app.default
def reproduce(*, out: Folder = Path("out/paper"), json: Json = False) -> None:
    """Make every figure and number of the paper, and compare."""
    from flexbase.report.paper.all_figures import reproduce as reproduce_paper

    with progress_bar(plain_lines=True) as report:
        found = reproduce_paper(out, report)
    say("reproduce", found.to_dict(), found.sheet(), json, out)
