"""Run the sweep that a command line asks for, with a bar; or two, and their difference."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from flexbase.cli.options.values import Names
from flexbase.cli.terminal.cells_bar import cells_bar
from flexbase.errors import InputError
from flexbase.model.loop import HasGain
from flexbase.plant import Plant
from flexbase.sweeps import Cells, Execution, difference, sweep

if TYPE_CHECKING:
    import xarray


def check_difference(wanted: bool, compensator: Path | None, out: Path | None) -> None:
    """Raise InputError where a difference has nothing to compare, or nowhere to go."""
    if wanted and compensator is None:
        raise InputError("--difference: without and with what? Give --compensator FILE.")
    if wanted and out is not None and out.suffix.lower() == ".zarr":
        raise InputError(
            f"--difference: {out} is a store, which holds one sweep. Write two, then: "
            "flexbase draw AFTER --before BEFORE."
        )


def swept(plant: Plant, measures: Names, cells: Cells, execution: Execution, used: HasGain | None) -> xarray.Dataset:
    """The sweep."""
    with cells_bar(execution.store) as progress:
        return sweep(plant, measures, cells, loop=used, execution=execution, progress=progress)


def compared(plant: Plant, measures: Names, cells: Cells, execution: Execution, used: HasGain | None) -> xarray.Dataset:
    """What the compensator changes: with it minus without."""
    return difference(*(swept(plant, measures, cells, execution, one) for one in (None, used)))
