"""`flexbase reproduce`: the paper, end to end."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import Json
from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.progress import progress_bar
from flexbase.cli.terminal.show import facts, put, table, title

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
    if json:
        put(document("reproduce", found.to_dict()))
        return
    rows, notes = _with_notes(found.summary_rows())
    put(title("Ueda and Yoshikawa, ICRA 2003", f"figures and numbers in {out}"))
    put(table(["quantity", "paper", "ours", "difference", "note"], rows, widest=12))
    put(facts([(str(i), note) for i, note in enumerate(notes, start=1)]))


def _with_notes(rows: Iterable[Sequence[str]]) -> tuple[list[list[str]], list[str]]:
    """The rows with a number in place of each remark, and the remarks, each said once."""
    notes: dict[str, int] = {}
    drawn = []
    for *cells, remark in rows:
        drawn.append([*cells, str(notes.setdefault(remark, len(notes) + 1)) if remark else ""])
    return drawn, list(notes)
