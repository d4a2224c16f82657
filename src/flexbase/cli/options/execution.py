"""How a map is computed: the engine, where its blocks run, and whether it goes on with an earlier one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from cyclopts import Group, Parameter

EXECUTION = Group("Execution", sort_key=11)


@Parameter(name="*", group=EXECUTION)
@dataclass(frozen=True)
class ExecutionOptions:
    """Engine, workers and resumption."""

    engine: Annotated[str, Parameter(metavar="NAME", help="compiled, rows, or auto (if left out), by the cells")] = (
        "auto"
    )
    resume: Annotated[
        bool, Parameter(help="go on with an interrupted .zarr; start it if there is none", negative=())
    ] = False
    scheduler: Annotated[str | None, Parameter(metavar="URL", help="run blocks on a Dask cluster: tcp://...")] = None
    workers: Annotated[int | None, Parameter(metavar="N", help="run blocks on N processes of a local cluster")] = None
