"""Sweeps: many configurations at once."""

from flexbase.sweep.difference import difference
from flexbase.sweep.opened import open_dataset
from flexbase.sweep.parameters import PARAMETERS
from flexbase.sweep.run import sweep
from flexbase.sweep.status import STATUS
from flexbase.sweep.summary import document, save_csv, save_netcdf, summary

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
