"""`flexbase robots`: what is bundled."""

from __future__ import annotations

from cyclopts import App

from flexbase.cli.options.common import Json
from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.show import put, table
from flexbase.model.files.project import bundled

app = App(
    name="robots",
    help_epilogue="""Examples:
  flexbase robots
  flexbase check ueda2003""",
)


@app.default
def robots(*, json: Json = False) -> None:
    """Names that stand for ROBOT, and what each is."""
    found = bundled()
    content = {"robots": [{"name": name, "description": text} for name, text in found.items()]}
    put(document("robots", content)) if json else put(
        table(["robot", "what it is"], list(found.items()), words=(0, 1), blank_after=False)
    )
