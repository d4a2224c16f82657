"""`flexbase init`: a commented project file, and the schema that editors check it with."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.terminal.out import write_text
from flexbase.cli.terminal.screen import put
from flexbase.errors import InputError
from flexbase.model.files.start import init as init_at
from flexbase.model.files.start import schema_text

app = App(
    name="init",
    usage="Usage: flexbase init [FILE] [OPTIONS]",
    help_epilogue="""Examples:
  flexbase init gantry.toml
  flexbase check gantry.toml
  flexbase init --schema flexbase.schema.json

An existing project is never overwritten. With --schema alone, only the schema
is written (an older one is replaced); editors then check the project as you
type: put   #:schema ./flexbase.schema.json   in its first line.""",
)
Schema = Annotated[Path | None, Parameter(metavar="FILE", help="write the JSON schema of project files (.json)")]
DEFAULT = Path("project.toml")


@app.default
def init(
    file: Annotated[Path | None, Parameter(help="the new project, project.toml if left out")] = None,
    /,
    *,
    schema: Schema = None,
) -> None:
    """Write a project that loads as it stands, every key explained."""
    if schema is not None:
        if schema.suffix.lower() != ".json":
            raise InputError(f'--schema: {schema} ends in "{schema.suffix}". Give a file that ends in .json.')
        write_text(schema, schema_text())
        put(f"Written: {schema}")
    if file is not None or schema is None:
        project = init_at(file or DEFAULT)
        put(f"Written: {project}", f"Next: flexbase check {project}")
