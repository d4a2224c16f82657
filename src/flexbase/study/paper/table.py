"""A comparison of printed numbers with ours, as rows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from flexbase.sheets.plain import Plain
from flexbase.sheets.sheet import Column, Sheet, facts, make_sheet, table, words
from flexbase.sheets.told import Told

WIDEST = 12  # signs of a number


@dataclass(frozen=True)
class PaperRow(Plain):
    """One line of the comparison.

    paper, ours : a number, or words; paper is None where nothing is printed
    digits : decimals shown, or significant digits where negative
    """

    quantity: str
    paper: float | str | None
    ours: float | str
    digits: int = 4
    remark: str = ""

    document: ClassVar = ("quantity", "paper", "ours", "difference", "remark")

    @property
    def difference(self) -> float | None:
        """Ours less the paper's, where both are numbers."""
        both = isinstance(self.paper, float) and isinstance(self.ours, float)
        return float(self.ours) - float(self.paper) if both and self.paper is not None else None

    def shown(self) -> tuple[str, str, str, str, str]:
        """Quantity, paper, ours, difference, remark."""
        paper = self.paper if isinstance(self.paper, str) else "" if self.paper is None else f"{self.paper:g}"
        ours = self.ours if isinstance(self.ours, str) else self._number(self.ours)
        gap = "" if self.difference is None else self._gap(self.difference)
        return self.quantity, paper, ours, gap, self.remark

    def _number(self, value: float) -> str:
        return f"{value:.{-self.digits}g}" if self.digits < 0 else f"{value:.{self.digits}f}"

    def _gap(self, value: float) -> str:
        text = f"{value:+.2g}" if self.digits < 0 else f"{value:+.{self.digits}f}"
        return "0" if float(text) == 0.0 else text


@dataclass(frozen=True)
class Reproduction(Told):
    """The paper's numbers beside ours."""

    rows: tuple[PaperRow, ...]

    def summary_rows(self) -> list[tuple[str, str, str, str, str]]:
        """Quantity, paper, ours, difference and remark of each row, as words."""
        return [row.shown() for row in self.rows]

    def sheet(self) -> Sheet:
        """A row a quantity, remarks by number, and the remarks below."""
        remarks = list(dict.fromkeys(row.remark for row in self.rows if row.remark))
        columns = [Column(name, widest=WIDEST) for name in ("paper", "ours", "difference", "note")]
        rows = ([*cells, str(remarks.index(said) + 1) if said else ""] for *cells, said in self.summary_rows())
        return make_sheet(
            "Ueda and Yoshikawa, ICRA 2003",
            "what the paper prints, and ours",
            table([words("quantity"), *columns], rows),
            facts(*((str(i), remark) for i, remark in enumerate(remarks, start=1))),
        )
