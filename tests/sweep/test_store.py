"""Stores: resumed bit by bit after a kill, never mixed, never lost."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from zarr.storage import _local

import flexbase as fb
from flexbase.model.base import make_base
from flexbase.sweeps.engine.job import Job
from flexbase.sweeps.kept.store import FINISHED

SHAPE = (2048, 2600)  # five blocks of 512 or so rows
ROOT = Path(__file__).parents[2]


def files(store: Path) -> dict[str, bytes]:
    return {str(path.relative_to(store)): path.read_bytes() for path in sorted(store.rglob("*")) if path.is_file()}


def finished(store: Path) -> int:
    """How many blocks are marked."""
    return sum(path.is_file() for path in (store / FINISHED / "c").rglob("*"))


@pytest.fixture(scope="module")
def whole(paper: fb.Plant, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An undisturbed run."""
    path = tmp_path_factory.mktemp("whole") / "map.zarr"
    fb.sweep(paper, cells=fb.Cells(shape=SHAPE), execution=fb.Execution(store=path))
    return path


def test_store_is_the_answer_in_memory(paper: fb.Plant, whole: Path) -> None:
    kept, held = fb.open_dataset(whole), fb.sweep(paper, cells=fb.Cells(shape=SHAPE))
    assert np.array_equal(kept["status"].values, held["status"].values)
    assert np.array_equal(kept["robustness"].values, held["robustness"].values, equal_nan=True)
    assert kept["robustness"].attrs == held["robustness"].attrs
    assert {"robot", "flexbase_recipe"} <= set(kept.attrs)
    recipe = json.loads(kept.attrs["flexbase_recipe"])
    assert len(recipe["model"]) == 64
    assert recipe["versions"]["flexbase"] == fb.__version__


def interrupted(paper: fb.Plant, path: Path, after: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A sweep that stops at its n-th block, as by Ctrl-C."""
    run, calls = Job.run, []

    def limited(self: Job, work: object) -> object:
        calls.append(work)
        if len(calls) > after:
            raise KeyboardInterrupt
        return run(self, work)  # type: ignore[arg-type]

    with monkeypatch.context() as patch:
        patch.setattr(Job, "run", limited)
        with pytest.raises(KeyboardInterrupt):
            fb.sweep(paper, cells=fb.Cells(shape=SHAPE), execution=fb.Execution(store=path))


@pytest.mark.parametrize("after", [0, 1, 3])
def test_interrupted_and_resumed(
    paper: fb.Plant, whole: Path, tmp_path: Path, after: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "map.zarr"
    interrupted(paper, path, after, monkeypatch)
    assert finished(path) == after < finished(whole)
    seen: list[int] = []
    fb.sweep(
        paper,
        progress=lambda what, done, total: seen.append(done),
        cells=fb.Cells(shape=SHAPE),
        execution=fb.Execution(store=path, resume=True),
    )
    assert files(path) == files(whole)
    assert len(seen) == 1 + finished(whole) - after  # no block is computed twice


@pytest.mark.slow
def test_killed_at_random_and_resumed(whole: Path, tmp_path: Path) -> None:
    """SIGKILL three times, wherever it hits; then the same command finishes, and once more does nothing."""
    path = tmp_path / "map.zarr"
    shape = ",".join(map(str, SHAPE))
    command = [sys.executable, "-m", "flexbase", "sweep", "ueda2003", "--shape", shape, "--out", str(path), "--resume"]
    rng = np.random.default_rng(0)
    started = time.monotonic()
    run = subprocess.run([*command[:5], "--shape", "9,9"], check=True, capture_output=True, timeout=120)
    startup = time.monotonic() - started
    assert run.stdout
    for _ in range(3):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, cwd=ROOT)
        time.sleep(startup * rng.uniform(0.7, 1.3))
        process.send_signal(signal.SIGKILL)
        process.wait(timeout=60)
    for _ in range(2):
        done = subprocess.run(command, capture_output=True, cwd=ROOT, timeout=300)
        assert (done.returncode, done.stderr) == (0, b"")
    assert files(path) == files(whole)
    assert [entry.name for entry in tmp_path.iterdir()] == ["map.zarr"]  # nothing half-made is left beside it


@pytest.mark.parametrize("half", ["missing", "empty folder", "no attributes", "torn metadata", "arrays without recipe"])
def test_half_created_stores_are_started(paper: fb.Plant, whole: Path, tmp_path: Path, half: str) -> None:
    path = tmp_path / "map.zarr"
    if half != "missing":
        path.mkdir()
    if half == "no attributes":
        (path / "zarr.json").write_text('{"zarr_format": 3, "node_type": "group", "attributes": {}}')
    if half == "torn metadata":
        (path / "zarr.json").write_text('{"zarr_form')
    if half == "arrays without recipe":
        shutil.copytree(whole / "status", path / "status", ignore=shutil.ignore_patterns("c"))
    fb.sweep(paper, cells=fb.Cells(shape=SHAPE), execution=fb.Execution(store=path, resume=True))
    assert files(path) == files(whole)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"measures": ["alignment"]}, "measures"),
        ({"bounds": (0.0, 0.5, -0.2, 0.2)}, "domain"),
        ({"branch": "-"}, "branch"),
        ({"engine": "rows"}, "engine"),
    ],
)
def test_another_recipe_is_refused(paper: fb.Plant, whole: Path, options: dict, said: str) -> None:
    before = files(whole)
    with pytest.raises(fb.InputError, match=f"another recipe.*{said}"):
        fb.sweep(
            paper,
            options.get("measures", ["robustness"]),
            fb.Cells(shape=SHAPE, **{name: options[name] for name in ("bounds", "branch") if name in options}),
            execution=fb.Execution(store=whole, resume=True, engine=options.get("engine", "auto")),
        )
    assert files(whole) == before


def test_another_model_is_refused(whole: Path) -> None:
    arm = fb.load("ueda2003").arm
    other = fb.Plant(replace(arm, base=make_base([3.1e4], [10.0], [0.0], 1)))
    with pytest.raises(fb.InputError, match="model"):
        fb.sweep(other, cells=fb.Cells(shape=SHAPE), execution=fb.Execution(store=whole, resume=True))


def test_what_is_there_is_never_overwritten(paper: fb.Plant, whole: Path, tmp_path: Path) -> None:
    with pytest.raises(fb.InputError, match="already exists"):
        fb.sweep(paper, cells=fb.Cells(shape=SHAPE), execution=fb.Execution(store=whole))
    foreign = tmp_path / "photos.zarr"
    foreign.mkdir()
    (foreign / "cat.png").write_bytes(b"meow")
    for resume in (False, True):
        with pytest.raises(fb.InputError, match=r"photos\.zarr"):
            fb.sweep(paper, cells=fb.Cells(shape=SHAPE), execution=fb.Execution(store=foreign, resume=resume))
    assert (foreign / "cat.png").read_bytes() == b"meow"


def test_unwritable_place(paper: fb.Plant, tmp_path: Path) -> None:
    with pytest.raises(fb.InputError, match=r"nowhere.*cannot be written"):
        fb.sweep(paper, cells=fb.Cells(shape=SHAPE), execution=fb.Execution(store=tmp_path / "nowhere" / "map.zarr"))


def test_full_disk_keeps_finished_blocks(
    paper: fb.Plant, whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """ENOSPC at the third block: one line that says so, and the rest follows with resume."""
    path, put, count = tmp_path / "map.zarr", _local._put, []

    def full(*arguments: object, **options: object) -> object:
        if f"{os.sep}robustness{os.sep}c{os.sep}" in str(arguments[0]):
            count.append(1)
            if len(count) >= 3:
                raise OSError(28, "No space left on device")
        return put(*arguments, **options)

    with monkeypatch.context() as patch:
        patch.setattr(_local, "_put", full)
        with pytest.raises(fb.InputError, match=r"the disk is full.*--resume"):
            fb.sweep(paper, cells=fb.Cells(shape=SHAPE), execution=fb.Execution(store=path))
    assert 1 <= finished(path) <= 2
    fb.sweep(paper, cells=fb.Cells(shape=SHAPE), execution=fb.Execution(store=path, resume=True))
    assert files(path) == files(whole)
