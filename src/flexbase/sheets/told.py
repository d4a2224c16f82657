"""A result that tells itself: once as a sheet for people, once as plain numbers for programs."""

from __future__ import annotations

from abc import ABC, abstractmethod

from flexbase.sheets.html import html
from flexbase.sheets.plain import Plain
from flexbase.sheets.sheet import Sheet
from flexbase.sheets.text import text


class Told(Plain, ABC):
    """A result of flexbase. What it says is in `sheet`; text, notebooks, pages and the command line render that."""

    @abstractmethod
    def sheet(self) -> Sheet:
        """Heading, facts, tables and answers."""

    def summary(self) -> str:
        """The sheet in plain text."""
        return text(self.sheet())

    def _repr_html_(self) -> str:
        """The sheet in a notebook."""
        return html(self.sheet())
