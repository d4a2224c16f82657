"""Sweeps: many configurations at once."""

from flexbase.sweeps.answers.difference import difference
from flexbase.sweeps.answers.summary import document, save_csv, save_netcdf, summary
from flexbase.sweeps.cells.parameters import PARAMETERS
from flexbase.sweeps.engine.status import STATUS
from flexbase.sweeps.kept.opened import open_dataset
from flexbase.sweeps.run import sweep

__all__ = [
    "PARAMETERS",
    "STATUS",
    "difference",
    "document",
    "open_dataset",
    "save_csv",
    "save_netcdf",
    "summary",
    "sweep",
]
