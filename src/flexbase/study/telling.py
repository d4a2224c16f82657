"""Any result as a sheet, or in plain text: those that tell themselves, and datasets."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flexbase.errors import InputError
from flexbase.sheets.sheet import Sheet
from flexbase.sheets.text import text
from flexbase.sheets.told import Told
from flexbase.study.montecarlo.result import MonteCarlo, is_study
from flexbase.sweeps.answers.summary import sheet_of

if TYPE_CHECKING:
    import xarray


def sheet(result: Told | xarray.Dataset) -> Sheet:
    """Heading, facts, tables and answers of what a verb returned. Raises InputError for what is no result."""
    if isinstance(result, Told):
        return result.sheet()
    if is_study(result):
        return MonteCarlo(result).sheet()
    if hasattr(result, "data_vars") and "status" in result:
        return sheet_of(result)
    raise InputError(f"{type(result).__name__}: no result of flexbase. Give what one of its verbs returned.")


def summary(result: Told | xarray.Dataset) -> str:
    """The sheet in plain text. Raises InputError for what is no result."""
    return text(sheet(result))
