"""A comparison of printed numbers with ours, as rows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class PaperRow:
    """One line of the comparison.

    paper, ours : a number, or words; paper is None where nothing is printed
    digits : decimals shown, or significant digits where negative
    """

    quantity: str
    paper: float | str | None
    ours: float | str
    digits: int = 4
    remark: str = ""

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
class PaperTable:
    """The paper's numbers beside ours."""

    rows: tuple[PaperRow, ...]

    def summary_rows(self) -> list[tuple[str, str, str, str, str]]:
        """Quantity, paper, ours, difference and remark of each row, as words."""
        return [row.shown() for row in self.rows]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and words."""
        return {
            "rows": [
                {
                    "quantity": row.quantity,
                    "paper": row.paper,
                    "ours": row.ours,
                    "difference": row.difference,
                    "remark": row.remark,
                }
                for row in self.rows
            ]
        }
