"""The one pool of processes: many small questions on several cores, each process with one thread for its matrices."""

from __future__ import annotations

import multiprocessing
import os
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial
from typing import Any, TypeVar

from flexbase.cautions import collected
from flexbase.errors import FlexbaseError, InputError
from flexbase.trace.kernel import cores

Task = TypeVar("Task")
Answer = TypeVar("Answer")
Mapper = Callable[[Callable[[Any], Any], Sequence[Any]], Iterator[Any]]
FEW = 4  # tasks that are not worth starting a process for


def in_processes(
    ask: Callable[[Task], Answer], tasks: Sequence[Task], workers: int | None = None
) -> Iterator[tuple[int, Answer]]:
    """The number of each task and its answer, in any order; `workers` processes, one a core if left out.

    With one worker, or few tasks, they are answered here. Cautions of the tasks are not told. Raises InputError.
    """
    count = _count(workers)
    if count == 1 or len(tasks) <= FEW:
        for number, task in enumerate(tasks):
            yield number, _quietly(ask, task)
        return
    with _processes(count) as pool:
        futures = {pool.submit(_quietly, ask, task): number for number, task in enumerate(tasks)}
        for future in as_completed(futures):
            yield futures[future], future.result()


@contextmanager
def mapping(workers: int | None = None) -> Iterator[Mapper]:
    """`map` over processes that are started once: answers in the order of the tasks. Raises InputError."""
    count = _count(workers)
    if count == 1:
        yield lambda ask, tasks: map(partial(_quietly, ask), tasks)
        return
    with _processes(count) as pool:
        yield lambda ask, tasks: pool.map(partial(_quietly, ask), tasks)


def check_workers(workers: int | None) -> None:
    """Raise InputError unless it is a whole number from 1 up, or None."""
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise InputError(f"workers: {workers!r} given, a whole number from 1 up is needed, or nothing for one a core.")


def _count(workers: int | None) -> int:
    check_workers(workers)
    return cores() if workers is None else workers


@contextmanager
def _processes(count: int) -> Iterator[ProcessPoolExecutor]:
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(count, mp_context=context, initializer=_begin) as pool:
        try:
            yield pool
        except BrokenProcessPool as fault:
            raise FlexbaseError(
                "workers: a process died, perhaps for want of memory. Give fewer workers; what a store holds is kept."
            ) from fault
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _begin() -> None:
    """What a new process does first: one thread for small matrices, since more would wait for each other."""
    import scipy.linalg  # noqa: F401  its BLAS is another one than NumPy's, and can be told only once it is there
    from threadpoolctl import threadpool_limits

    threadpool_limits(1)
    warnings.simplefilter("ignore")  # of a process that nobody reads
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _quietly(ask: Callable[[Task], Answer], task: Task) -> Answer:
    with collected(quietly=True):
        return ask(task)
