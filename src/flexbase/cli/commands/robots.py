"""`flexbase robots`: what is bundled."""

from __future__ import annotations

from cyclopts import App

from flexbase.cli.options.common import Json
from flexbase.cli.terminal.show import say
from flexbase.model.files.project import bundled
from flexbase.sheets.sheet import make_sheet, table, words

app = App(
    name="robots",
    help_epilogue="""Examples:
  flexbase robots
  flexbase check ueda2003""",
)


@app.default
def robots(*, json: Json = False) -> None:
    """Names that stand for ROBOT, and what each is."""
    content = {"robots": [{"name": name, "description": text} for name, text in bundled().items()]}
    listed = table([words("robot"), words("what it is")], bundled().items())
    say("robots", content, make_sheet("Bundled robots", "", listed), json)
