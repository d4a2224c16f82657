"""A formula's answers, many at once: NumPy rows without a warm-up, or a compiled kernel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexbase.cautions import caution
from flexbase.checks import Array, choose
from flexbase.errors import MissingExtra
from flexbase.sweeps.engine.formula import Formula
from flexbase.sweeps.engine.question import Block
from flexbase.sweeps.engine.status import OK
from flexbase.trace.algebra import unstack
from flexbase.trace.kernel import Kernel, kernel_of

ROWS, COMPILED, AUTO = "rows", "compiled", "auto"
ENGINES = (AUTO, COMPILED, ROWS)
WORTH_COMPILING = 200_000  # evaluations from which a kernel gains more than the half second that it takes to make
ROW_BLOCK = 16384  # configurations evaluated together: their intermediate rows stay in the cache


class Engine(NamedTuple):
    """A formula, ready to be asked; `kernel` is None for NumPy rows."""

    formula: Formula
    kernel: Kernel | None = None

    @property
    def name(self) -> str:
        """ "rows" or "compiled"."""
        return ROWS if self.kernel is None else COMPILED

    def run(self, inputs: Array, threads: int | None = None) -> Block:
        """Answers for inputs of shape (inputs, cells)."""
        formula = self.formula
        results = self._results(inputs) if self.kernel is None else self.kernel(inputs, threads=threads)
        status = results[0].astype(np.int8)
        values, row = {}, 1
        for one in formula.quick:
            width = formula.width(one)
            values[one.name] = results[row : row + width].T if one.per_mode else results[row]
            row += width
        slow = [one for one in formula.measures if one.slow]
        for one in slow:
            values[one.name] = np.full(len(status), np.nan)
        good = np.flatnonzero(status == OK)
        for begin in range(0, len(good) if slow else 0, ROW_BLOCK):
            cells = good[begin : begin + ROW_BLOCK]
            configuration = formula.configuration(unstack(inputs[:, cells].T, 1))
            for one in slow:
                values[one.name][cells] = one.run(configuration)
        return Block({one.name: values[one.name] for one in formula.measures}, status)

    def _results(self, inputs: Array) -> Array:
        cells = inputs.shape[1]
        results = np.empty((1 + sum(map(self.formula.width, self.formula.quick)), cells))
        with np.errstate(all="ignore"):  # cells without a value divide by zero; their status says so
            for begin in range(0, cells, ROW_BLOCK):
                part = inputs[:, begin : begin + ROW_BLOCK]
                for row, value in enumerate(self.formula(tuple(part))):
                    results[row, begin : begin + ROW_BLOCK] = value
        return results


def compiled(formula: Formula) -> Engine:
    """The formula as machine code, from the cache or traced and compiled now. Raises MissingExtra."""
    return Engine(formula, kernel_of(formula, formula.inputs, formula.recipe))


_READY: dict[str, Engine] = {}


def engine_of(formula: Formula, name: str) -> Engine:
    """A formula on the engine of a name; one kernel a process and recipe: machine code cannot be sent to a worker."""
    if name == ROWS:
        return Engine(formula)
    if formula.recipe not in _READY:
        _READY[formula.recipe] = compiled(formula)
    return _READY[formula.recipe]


def chosen_engine(wanted: str, formula: Formula, evaluations: int) -> str:
    """The engine that will be used, made ready: a missing package shows before any work. Raises MissingExtra."""
    choose("engine", wanted, dict.fromkeys(ENGINES))
    if wanted == ROWS or (wanted == AUTO and evaluations < WORTH_COMPILING):
        return ROWS
    try:
        _READY[formula.recipe] = compiled(formula)
        return COMPILED
    except MissingExtra as missing:
        if wanted == COMPILED:
            raise
        caution(f"{missing} Until then maps run on NumPy, ten times slower.")
        return ROWS
