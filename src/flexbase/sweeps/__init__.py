"""Sweeps: many configurations at once."""

from flexbase.sweeps.answers.difference import difference
from flexbase.sweeps.answers.summary import document, save_csv
from flexbase.sweeps.answers.tables import save_netcdf
from flexbase.sweeps.cells.parameters import PARAMETERS
from flexbase.sweeps.engine.status import STATUS
from flexbase.sweeps.kept.opened import open_dataset
from flexbase.sweeps.requests import Cells, Execution
from flexbase.sweeps.run import sweep

__all__ = [
    "Cells",
    "Execution",
    "PARAMETERS",
    "STATUS",
    "difference",
    "document",
    "open_dataset",
    "save_csv",
    "save_netcdf",
    "sweep",
]
