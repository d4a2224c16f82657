"""Many small questions on several cores: results as they come, in processes of their own."""

from __future__ import annotations

import multiprocessing
import os
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from typing import TypeVar

from flexbase.errors import InputError
from flexbase.trace.kernel import cores

Task = TypeVar("Task")
Answer = TypeVar("Answer")
BLAS_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
FEW = 4  # tasks that are not worth starting a process for


def in_processes(
    ask: Callable[[Task], Answer], tasks: Sequence[Task], workers: int | None = None
) -> Iterator[tuple[int, Answer]]:
    """The number of each task and its answer, in any order; `workers` processes, one a core if left out.

    With one worker, or few tasks, they are answered here. Warnings of the tasks are not shown. Raises InputError.
    """
    check_workers(workers)
    count = cores() if workers is None else workers
    if count == 1 or len(tasks) <= FEW:
        for number, task in enumerate(tasks):
            yield number, _quietly(ask, task)
        return
    with one_blas_thread(), ProcessPoolExecutor(count, mp_context=multiprocessing.get_context("spawn")) as pool:
        futures = {pool.submit(_quietly, ask, task): number for number, task in enumerate(tasks)}
        try:
            for future in as_completed(futures):
                yield futures[future], future.result()
        finally:
            for future in futures:
                future.cancel()


def check_workers(workers: int | None) -> None:
    """Raise InputError unless it is a whole number from 1 up, or None."""
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise InputError(f"workers: {workers!r} given, a whole number from 1 up is needed, or nothing for one a core.")


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Processes started within use one thread each for their small matrices: more would wait for each other."""
    before = {name: os.environ.get(name) for name in BLAS_THREADS}
    os.environ.update(dict.fromkeys(BLAS_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name)
            else:
                os.environ[name] = value


def _quietly(ask: Callable[[Task], Answer], task: Task) -> Answer:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ask(task)
