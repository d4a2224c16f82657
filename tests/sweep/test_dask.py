"""The same blocks on a Dask cluster: the same bits, even when a worker is killed half-way."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import flexbase as fb
from flexbase.sweeps.kept.store import FINISHED

SHAPE = (1024, 4100)  # five blocks

pytestmark = pytest.mark.filterwarnings("ignore")  # of the cluster's own making


def bits(store: Path) -> dict[str, bytes]:
    return {str(path.relative_to(store)): path.read_bytes() for path in sorted(store.rglob("*")) if path.is_file()}


@pytest.fixture(scope="module")
def whole(paper: fb.Plant, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("whole") / "map.zarr"
    fb.sweep(paper, cells=fb.Cells(shape=SHAPE), execution=fb.Execution(store=path))
    return path


@pytest.mark.slow
def test_local_cluster_writes_the_same_store(whole: Path, tmp_path: Path) -> None:
    """By the command line, in a process of its own, as a user would."""
    path = tmp_path / "map.zarr"
    shape = ",".join(map(str, SHAPE))
    words = ["sweep", "ueda2003", "--shape", shape, "--out", str(path), "--workers", "2"]
    done = subprocess.run([sys.executable, "-m", "flexbase", *words], capture_output=True, timeout=240)
    assert (done.returncode, done.stderr) == (0, b"")
    assert bits(path) == bits(whole)


@pytest.mark.slow
def test_killed_worker_costs_its_block(paper: fb.Plant, whole: Path, tmp_path: Path) -> None:
    """A scheduler of its own; the first worker is killed as soon as a block is done."""
    distributed = pytest.importorskip("distributed")
    path, killed = tmp_path / "map.zarr", []
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "silence_logs": 60}
    with distributed.LocalCluster(**options) as cluster:

        def kill(what: str, done: int, total: int) -> None:
            if not killed and 0 < done < total:
                killed.append(cluster.workers[0].pid)
                os.kill(killed[0], signal.SIGKILL)

        fb.sweep(
            paper,
            progress=kill,
            cells=fb.Cells(shape=SHAPE),
            execution=fb.Execution(store=path, scheduler=cluster.scheduler_address),
        )
    assert killed
    assert sum(mark.is_file() for mark in (path / FINISHED / "c").rglob("*")) == 5
    assert bits(path) == bits(whole)


def test_results_in_memory(paper: fb.Plant) -> None:
    found = fb.sweep(paper, ["alignment"], fb.Cells(shape=(50, 40)), execution=fb.Execution(workers=1))
    assert np.array_equal(
        found["alignment"], fb.sweep(paper, ["alignment"], fb.Cells(shape=(50, 40)))["alignment"], equal_nan=True
    )


@pytest.mark.slow
def test_no_scheduler_there(paper: fb.Plant) -> None:
    with pytest.raises(fb.InputError, match=r"scheduler: no Dask scheduler answers at tcp://127\.0\.0\.1:9"):
        fb.sweep(paper, cells=fb.Cells(shape=(5, 5)), execution=fb.Execution(scheduler="tcp://127.0.0.1:9"))
