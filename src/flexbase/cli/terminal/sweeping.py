"""Run the sweep that a command line asks for, with a bar; or two, and their difference."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from flexbase.cli.options.execution import ExecutionOptions
from flexbase.cli.options.plane import PlaneOptions
from flexbase.cli.options.words import Names
from flexbase.cli.terminal.cells_bar import cells_bar
from flexbase.control.compensator import Compensator
from flexbase.errors import InputError
from flexbase.plant import Plant
from flexbase.sweeps import difference, sweep


def check_difference(wanted: bool, compensator: Path | None, out: Path | None) -> None:
    """Raise InputError where a difference has nothing to compare, or nowhere to go."""
    if wanted and compensator is None:
        raise InputError("--difference: without and with what? Give --compensator FILE.")
    if wanted and out is not None and out.suffix.lower() == ".zarr":
        raise InputError(
            f"--difference: {out} is a store, which holds one sweep. Write two, then: "
            "flexbase draw AFTER --before BEFORE."
        )


def swept(
    plant: Plant,
    measures: Names,
    plane: PlaneOptions,
    execution: ExecutionOptions,
    used: Compensator | None,
    store: Path | None,
) -> Any:
    """The sweep, an `xarray.Dataset`."""
    with cells_bar(store) as progress:
        return sweep(
            plant,
            measures,
            plane.over,
            plane.shape,
            bounds=plane.bounds,
            branch=plane.elbow,
            axes=plane.axes,
            hold=plane.hold,
            vary=dict(plane.vary),
            loop=used,
            sampling=plane.sampling,
            seed=plane.seed,
            store=store,
            progress=progress,
            **vars(execution),
        )


def compared(
    plant: Plant, measures: Names, plane: PlaneOptions, execution: ExecutionOptions, used: Compensator | None
) -> Any:
    """What the compensator changes: with it minus without."""
    return difference(*(swept(plant, measures, plane, execution, one, None) for one in (None, used)))
