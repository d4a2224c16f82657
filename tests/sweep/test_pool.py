"""The pool of processes: answers in order or as they come, one thread for matrices, nothing left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from threadpoolctl import threadpool_info

import flexbase as fb
from flexbase.cautions import caution
from flexbase.sweeps.engine.pool import in_processes, mapping


def threads(_: int = 0) -> list[int]:
    """Of every BLAS of this process."""
    import scipy.linalg  # noqa: F401

    return [one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"]


def told(task: int) -> int:
    caution(f"task {task}")
    return task * task


def dies(_: int) -> None:
    os._exit(9)


def refuses(task: int) -> None:
    raise fb.Infeasible(f"task {task}: no")


def test_a_process_uses_one_thread_and_ours_stays_as_it_is() -> None:
    before = dict(os.environ), threads()
    assert [set(found) for _, found in in_processes(threads, range(6), 2)] == [{1}] * 6
    assert (dict(os.environ), threads()) == before


@pytest.mark.parametrize("workers", [1, 2])
def test_answers_are_ours_and_cautions_are_not_told(workers: int) -> None:
    """In order where they are mapped; each once, with its number, where they come as they are done."""
    with mapping(workers) as each:
        assert list(each(told, range(7))) == [i * i for i in range(7)]
        assert list(each(abs, [-2, 1])) == [2, 1]
    assert sorted(in_processes(told, range(7), workers)) == [(i, i * i) for i in range(7)]


@pytest.mark.parametrize("workers", [1, 2])
def test_a_fault_of_a_task_is_the_callers(workers: int) -> None:
    with pytest.raises(fb.Infeasible, match=r"task \d: no"):
        list(in_processes(refuses, range(7), workers))


def test_a_process_that_dies_is_told_with_a_mend() -> None:
    with pytest.raises(fb.FlexbaseError, match=r"a process died.*fewer workers"):
        list(in_processes(dies, range(7), 2))


@pytest.mark.parametrize("workers", [0, -1, True, 1.5])
def test_workers_that_are_none(workers: object) -> None:
    with pytest.raises(fb.InputError, match="workers"):
        list(in_processes(abs, [1], workers))  # type: ignore[arg-type]


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are counted in /proc")
def test_a_killed_parent_leaves_no_process() -> None:
    """Its workers notice within seconds, in the middle of a task."""
    program = (
        "import time\n"
        "from flexbase.sweeps.engine.pool import in_processes\n"
        "if __name__ == '__main__':\n"
        "    list(in_processes(time.sleep, [600.0] * 6, 2))\n"
    )
    parent = subprocess.Popen([sys.executable, "-c", program], stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 120.0
    while len(workers := children(parent.pid)) < 2 and time.monotonic() < deadline:
        time.sleep(0.2)
    time.sleep(2.0)  # until they have begun
    parent.send_signal(signal.SIGKILL)
    parent.wait(timeout=60)
    assert len(workers) == 2
    while any(map(alive, workers)) and time.monotonic() < deadline:
        time.sleep(0.2)
    assert not any(map(alive, workers))


def children(parent: int) -> list[int]:
    """Workers of a process."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            line, words = stat.read_text(), (stat.parent / "cmdline").read_bytes()
        except OSError:  # it has ended meanwhile
            continue
        if int(line.rpartition(")")[2].split()[1]) == parent and b"spawn_main" in words:
            found.append(int(stat.parent.name))
    return found


def alive(process: int) -> bool:
    try:
        return (Path("/proc") / str(process) / "stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
