"""The question of a sweep: measures of every cell, by a formula."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from flexbase.checks import Array
from flexbase.sweeps.engine.evaluate import engine_of
from flexbase.sweeps.engine.formula import Formula
from flexbase.sweeps.engine.question import COMPANION, MODE, Block, Column
from flexbase.sweeps.engine.status import STATUS


@dataclass(frozen=True, eq=False)
class Traced:
    """A formula on an engine, "rows" or "compiled"; measures that nobody `asked` for are marked as companions."""

    formula: Formula
    engine: str
    asked: tuple[str, ...]
    meanings: ClassVar[Mapping[int, str]] = STATUS
    threads: ClassVar[bool] = True

    @property
    def columns(self) -> tuple[Column, ...]:
        """The measures."""
        found = []
        for one in self.formula.measures:
            said = {"units": one.unit, "long_name": one.purpose}
            said |= {"zero_is": one.zero_is} if one.zero_is else {}
            said |= {} if one.name in self.asked else {COMPANION: "1"}
            found.append(Column(one.name, said, (MODE, self.formula.arm.m) if one.per_mode else None))
        return tuple(found)

    @property
    def recipe(self) -> dict[str, Any]:
        """What the values depend on, beside cells and measures."""
        E = self.formula.E
        return {"compensator": None if E is None else E.tolist(), "engine": self.engine}

    def answer(self, inputs: Array) -> Block:
        """Status and measures."""
        return engine_of(self.formula, self.engine).run(inputs, threads=1)
