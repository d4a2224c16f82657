"""Inputs -> status and measures, many at once: NumPy rows without a warm-up, or a compiled kernel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.sweeps.engine.question import Question
from flexbase.sweeps.engine.status import OK
from flexbase.trace.algebra import unstack
from flexbase.trace.kernel import Kernel, kernel_of

ROWS, COMPILED, AUTO = "rows", "compiled", "auto"
ENGINES = (AUTO, COMPILED, ROWS)
ROW_BLOCK = 16384  # configurations evaluated together: their intermediate rows stay in the cache


class Block(NamedTuple):
    """Measures and status of some configurations.

    values : a measure's name -> shape (cells,), or (cells, m) for measures of each mode
    """

    values: dict[str, Array]
    status: NDArray[np.int8]


class Engine(NamedTuple):
    """A question, ready to be asked; `kernel` is None for NumPy rows."""

    question: Question
    kernel: Kernel | None = None

    @property
    def name(self) -> str:
        """ "rows" or "compiled"."""
        return ROWS if self.kernel is None else COMPILED

    def run(self, inputs: Array, threads: int | None = None) -> Block:
        """Answers for inputs of shape (inputs, cells)."""
        question = self.question
        results = self._results(inputs) if self.kernel is None else self.kernel(inputs, threads=threads)
        status = results[0].astype(np.int8)
        values, row = {}, 1
        for one in question.quick:
            width = question.width(one)
            values[one.name] = results[row : row + width].T if one.per_mode else results[row]
            row += width
        slow = [one for one in question.measures if one.slow]
        for one in slow:
            values[one.name] = np.full(len(status), np.nan)
        good = np.flatnonzero(status == OK)
        for begin in range(0, len(good) if slow else 0, ROW_BLOCK):
            cells = good[begin : begin + ROW_BLOCK]
            configuration = question.configuration(unstack(inputs[:, cells].T, 1))
            for one in slow:
                values[one.name][cells] = one.run(configuration)
        return Block({one.name: values[one.name] for one in question.measures}, status)

    def _results(self, inputs: Array) -> Array:
        cells = inputs.shape[1]
        results = np.empty((1 + sum(map(self.question.width, self.question.quick)), cells))
        with np.errstate(all="ignore"):  # cells without a value divide by zero; their status says so
            for begin in range(0, cells, ROW_BLOCK):
                part = inputs[:, begin : begin + ROW_BLOCK]
                for row, value in enumerate(self.question(tuple(part))):
                    results[row, begin : begin + ROW_BLOCK] = value
        return results


def compiled(question: Question) -> Engine:
    """The question as machine code, from the cache or traced and compiled now. Raises MissingExtra."""
    return Engine(question, kernel_of(question, question.inputs, question.recipe))
