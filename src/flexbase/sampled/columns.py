"""Figures of verdicts in tables: the columns, cells and legend that the registry declares."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from flexbase.sampled.figures import FIGURES, Figure, Shown
from flexbase.sheets.numbers import number
from flexbase.sheets.sheet import Column, Facts, facts

Values = Mapping[str, float | None]


def columns(names: Iterable[str]) -> list[Column]:
    """The columns of these figures, each with those that share it."""
    return [Column(one.heading, one.unit) for one in _shared(names)]


def cells(values: Values, names: Iterable[str]) -> list[str]:
    """What stands in the columns; - for what is undefined."""
    parts = [[_cell(one, values[figure.name]) for figure in figures] for one, figures in _shared(names).items()]
    return [" ".join(part) if set(part) != {"-"} else "-" for part in parts]


def legend(names: Iterable[str]) -> str:
    """What the headings mean."""
    return "; ".join(f"{one.heading}: {one.legend}".replace("\n", " ") for one in _shared(names))


def below(rows: Mapping[str, Values], names: Iterable[str]) -> Facts:
    """The figures without a column, each with the rows that have it.

    rows : label of a row -> its figures
    """
    apart = [FIGURES[name] for name in names if FIGURES[name].shown is None]
    return facts(*((one.purpose, said) for one in apart if (said := _listed(rows, one.name))))


def _listed(rows: Mapping[str, Values], name: str) -> str:
    return ", ".join(f"{label} {number(one[name], 4)}" for label, one in rows.items() if one[name] is not None)


def _shared(names: Iterable[str]) -> dict[Shown, list[Figure]]:
    found: dict[Shown, list[Figure]] = {}
    for name in names:
        if (shown := FIGURES[name].shown) is not None:
            found.setdefault(shown, []).append(FIGURES[name])
    return found


def _cell(one: Shown, value: float | None) -> str:
    return "-" if value is None else one.of(value)
