"""Who runs the blocks: threads of this process, or workers of a Dask cluster. Results come as they finish."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from typing import Any, Protocol

from flexbase.checks import Array
from flexbase.errors import InputError, import_extra
from flexbase.sweeps.engine.job import Job, Work
from flexbase.trace.kernel import cores

Result = tuple[Work, Mapping[str, Array]]
AHEAD = 2  # blocks a thread that wait or run: bounds the memory


class Runs(Protocol):
    """What blocks are given to."""

    def run(self, work: Work) -> Mapping[str, Any]:
        """The arrays of a block."""
        ...


def by_threads(job: Runs, blocks: Sequence[Work]) -> Iterator[Result]:
    """Run on all cores of this process. A block that has begun is finished even if the caller stops."""
    with ThreadPoolExecutor(cores(), thread_name_prefix="flexbase-sweep") as pool:
        running: dict[Future[Mapping[str, Array]], Work] = {}
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


def by_dask(job: Job, blocks: Sequence[Work], scheduler: str | None, workers: int | None) -> Iterator[Result]:
    """Run on a Dask cluster: a running one at an address, or `workers` processes started here for this sweep.

    A worker that dies costs the block that it was at: Dask gives it to another. Raises InputError, MissingExtra.
    """
    with _client(scheduler, workers) as client:
        distributed = import_extra("distributed", "maps")
        carried = client.scatter(job, broadcast=True)
        futures = {client.submit(_run, carried, work, pure=False, retries=2): work for work in blocks}
        for done, result in distributed.as_completed(futures, with_results=True):
            yield futures.pop(done), result


def _run(job: Job, work: Work) -> Mapping[str, Array]:
    return job.run(work)


@contextmanager
def _client(scheduler: str | None, workers: int | None) -> Iterator[Any]:
    distributed = import_extra("distributed", "maps")
    if scheduler is None:
        with (
            distributed.LocalCluster(
                n_workers=workers or cores(), threads_per_worker=1, dashboard_address=None, silence_logs=50
            ) as cluster,
            distributed.Client(cluster) as client,
        ):
            yield client
        return
    try:
        client = distributed.Client(scheduler, timeout=5)
    except (OSError, ValueError, TimeoutError) as fault:
        raise InputError(
            f"scheduler: no Dask scheduler answers at {scheduler}. Start one with: dask scheduler; or leave it out."
        ) from fault
    with client:
        yield client
