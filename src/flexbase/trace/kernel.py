"""A traced function as a kernel: many configurations in, many results out, on all cores."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np
from numpy.typing import NDArray

from flexbase.trace import cache as store
from flexbase.trace.algebra import Scalar, Vector
from flexbase.trace.machine import MachineCode, compile_program, processor
from flexbase.trace.targets.emitter import LANES
from flexbase.trace.tracer import trace

Array = NDArray[np.float64]
GRAIN = 4096  # configurations below which a second thread costs more than it saves
SHARES = 8  # parts a thread, so that one that another program holds up does not keep the rest waiting


class Kernel:
    """Machine code of a function of `inputs` scalars that gives `outputs` of them."""

    def __init__(self, code: bytes, inputs: int, outputs: int) -> None:
        self.inputs, self.outputs = inputs, outputs
        self._code = MachineCode(code)

    def __call__(self, x: Array, out: Array | None = None, threads: int | None = None, steps: int = 1) -> Array:
        """Results of every configuration, shape (outputs, cells), of inputs of shape (inputs, cells).

        out : where to put them, rows contiguous; threads : all cores if left out
        steps : how often a kernel made with `iterate` runs on its own results, at least once
        """
        x = np.asarray(x, dtype=float)
        if x.shape[1:] != (1,) and (x.strides[1:] != (8,) or x.strides[0] % 8):
            x = np.ascontiguousarray(x)
        cells = x.shape[1]
        result = np.empty((self.outputs, cells)) if out is None else out
        if cells < LANES:
            padded = np.repeat(x[:, :1], LANES, axis=1) if cells else np.zeros((self.inputs, 0))
            padded[:, :cells] = x
            if cells:
                result[:] = self(padded, steps=steps)[:, :cells]
            return result
        grain = max(LANES, GRAIN // steps)
        workers = max(1, min(threads or cores(), cells // grain))
        if workers == 1:
            self._run(x, result, 0, cells, steps)
            return result
        parts = min(SHARES * workers, cells // grain)
        edges = [cells * part // parts // LANES * LANES for part in range(parts)] + [cells]
        spans = iter(list(zip(edges[:-1], edges[1:], strict=True)))

        def work(_: int) -> None:
            for span in spans:  # whoever is free takes the next
                self._run(x, result, *span, steps)

        list(_pool().map(work, range(workers)))
        return result

    def _run(self, x: Array, result: Array, begin: int, end: int, steps: int) -> None:
        """Whole blocks of lanes first; the rest by a last block that overlaps them, which gives the same bits."""
        whole = (end - begin) // LANES * LANES
        starts = [(begin, whole)] if begin + whole == end else [(begin, whole), (end - LANES, LANES)]
        for start, count in starts:
            self._code.entry(
                x.ctypes.data + 8 * start,
                result.ctypes.data + 8 * start,
                x.strides[0] // 8,
                result.strides[0] // 8,
                count,
                steps,
            )


def kernel_of(
    function: Callable[[Vector], Sequence[Scalar]],
    inputs: int,
    recipe: str,
    *,
    derivative: bool = False,
    iterate: bool = False,
) -> Kernel:
    """The kernel of a generic function, from the cache on disk or traced and compiled now.

    recipe : everything that the function's results depend on, in words and numbers; two functions of one recipe are
        taken to be the same. flexbase's own code, the compiler and the processor are added here.
    derivative : append the exact derivatives of every value by every input, value by value
    iterate : the outputs are the first inputs a step later, as of a recursion or an integrator
    Raises MissingExtra without CasADi or llvmlite.
    """
    key = "\n".join([store.source_digest(), processor(), str(inputs), str(derivative), str(iterate), recipe])
    kept = store.read(key)
    if kept is None:
        program = trace(function, inputs, derivative=derivative)
        kept = program.outputs.to_bytes(8, "little") + compile_program(program, iterate)
        store.write(key, kept)
    return Kernel(kept[8:], inputs, int.from_bytes(kept[:8], "little"))


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(cores(), thread_name_prefix="flexbase")
