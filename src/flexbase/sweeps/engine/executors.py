"""Who runs the blocks: threads, processes, or the workers of a Dask cluster. Results come as they finish."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from typing import Any

from numpy.typing import NDArray

from flexbase.errors import InputError, import_extra
from flexbase.sweeps.engine.job import Job, Work
from flexbase.sweeps.engine.pool import in_processes
from flexbase.sweeps.requests import Execution
from flexbase.trace.kernel import cores

Arrays = Mapping[str, NDArray[Any]]
Result = tuple[Work, Arrays]
AHEAD = 2  # blocks a thread that wait or run: bounds the memory


def run_blocks(job: Job, blocks: Sequence[Work], execution: Execution) -> Iterator[Result]:
    """The arrays of every block, by whom the execution says, else by all cores of this computer."""
    if not blocks:
        return
    if execution.scheduler is not None:
        yield from _by_dask(job, blocks, execution.scheduler)
    elif execution.workers is not None or not job.question.threads:
        for number, arrays in in_processes(job.run, blocks, execution.workers):
            yield blocks[number], arrays
    else:
        yield from _by_threads(job, blocks)


def _by_threads(job: Job, blocks: Sequence[Work]) -> Iterator[Result]:
    """Run on all cores of this process. A block that has begun is finished even if the caller stops."""
    with ThreadPoolExecutor(cores(), thread_name_prefix="flexbase-sweep") as pool:
        running: dict[Future[Arrays], Work] = {}
        rest = iter(blocks)
        try:
            while True:
                for work in rest:
                    running[pool.submit(job.run, work)] = work
                    if len(running) >= AHEAD * cores():
                        break
                if not running:
                    return
                for done in wait(running, return_when=FIRST_COMPLETED).done:
                    yield running.pop(done), done.result()
        finally:
            for waiting in running:
                waiting.cancel()


def _by_dask(job: Job, blocks: Sequence[Work], scheduler: str) -> Iterator[Result]:
    """Run on a Dask cluster. A worker that dies costs the block that it was at: Dask gives it to another."""
    with _client(scheduler) as client:
        distributed = import_extra("distributed", "maps")
        carried = client.scatter(job, broadcast=True)
        futures = {client.submit(Job.run, carried, work, pure=False, retries=2): work for work in blocks}
        for done, result in distributed.as_completed(futures, with_results=True):
            yield futures.pop(done), result


@contextmanager
def _client(scheduler: str) -> Iterator[Any]:
    distributed = import_extra("distributed", "maps")
    try:
        client = distributed.Client(scheduler, timeout=5)
    except (OSError, ValueError, TimeoutError) as fault:
        raise InputError(
            f"scheduler: no Dask scheduler answers at {scheduler}. Start one with: dask scheduler; or leave it out."
        ) from fault
    with client:
        yield client
