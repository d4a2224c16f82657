"""Read hostile robot files in worker processes, and report every traceback, crash, hang and nonsense.

    python tests/files/fuzz.py --inputs 30000 --workers 2 --seed 1

A worker announces each input before it reads it, so that the one that kills or hangs it is known.
"""

from __future__ import annotations

import argparse
import itertools
import multiprocessing
import sys
import tempfile
import time
import traceback
from collections import Counter
from multiprocessing.connection import Connection, wait
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as hypothesis_seed

sys.path.insert(0, str(Path(__file__).parents[1]))
from files.mutations import documents, hostile_files
from flexbase.errors import InputError
from flexbase.model.formats.robot import RobotFile, read_robot_file

SECONDS = 10.0  # for one input; a sound file takes some milliseconds
GROWN = 0.25  # share of the inputs that hypothesis grows
FROZEN = (
    "axes",
    "placement_rotation",
    "placement_position",
    "mass",
    "com",
    "inertia",
    "tool_rotation",
    "tool_position",
)
TOOLS = ("tip", "tool", "lower")


def nonsense(robot: RobotFile) -> str | None:
    """What an accepted robot must never be."""
    mechanism = robot.mechanism
    arrays = [getattr(mechanism, name) for name in FROZEN]
    arrays += [robot.friction, robot.armature, robot.stiffness, robot.reference]
    if not all(np.isfinite(array).all() and not array.flags.writeable for array in arrays):
        return "not finite or not frozen"
    if np.isnan(robot.limits).any() or robot.limits.shape != (mechanism.N, 2):
        return "limits"
    if (mechanism.mass < 0.0).any() or abs(np.linalg.norm(mechanism.axes, axis=1) - 1.0).max() > 1e-9:
        return "mass or axis"
    size = np.abs(mechanism.inertia).max(axis=(1, 2), initial=0.0)
    if (np.linalg.eigvalsh(mechanism.inertia)[:, 0] < -2e-4 * size).any():
        return "indefinite inertia"
    if not all(note.isprintable() for note in (*robot.notes, *mechanism.joint_names)):
        return "notes or names that cannot be printed"
    return None


def judge(path: Path, tool: str | None) -> str:
    """'accepted', 'refused', or what went wrong."""
    try:
        wrong = nonsense(read_robot_file(path, tool, folder=path.parent))
        return f"FAILED: {wrong}" if wrong else "accepted"
    except InputError as fault:
        message = str(fault)
        sound = message.isprintable() and len(message) <= 1000 and str(path.parent) not in message
        return "refused" if sound else "FAILED: message"
    except BaseException:
        return f"FAILED: {traceback.format_exc()}"


def work(pipe: Connection, folder: str, worker: int, seed: int, inputs: int) -> None:
    """Read `inputs` hostile files: announce, read, report."""
    counter = itertools.count()

    def one(content: bytes) -> None:
        number = next(counter)
        path = Path(folder) / f"worker{worker}.{'xml' if number % 2 else 'urdf'}"
        path.write_bytes(content)
        known = [tool for tool in TOOLS if f'name="{tool}"'.encode() in content]
        pipe.send(("reading", path.name))
        pipe.send((judge(path, known[0] if known and number % 8 else None), content[:20_000]))

    grown = int(inputs * GROWN)
    if grown:
        calm = settings(
            max_examples=grown,
            deadline=None,
            database=None,
            phases=[Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        hypothesis_seed(seed + worker)(calm(given(documents())(one)))()
    for content in itertools.islice(hostile_files(seed + 1000 * worker), max(0, inputs - next(counter))):
        one(content)
    pipe.send(("done", b""))


def fuzz(inputs: int, workers: int, seed: int) -> tuple[Counter[str], list[str]]:
    """Counts of what happened, and the failures."""
    counts: Counter[str] = Counter()
    failures: list[str] = []
    context = multiprocessing.get_context("spawn")
    with tempfile.TemporaryDirectory() as folder:
        running = {}
        for worker in range(workers):
            ours, theirs = context.Pipe()
            process = context.Process(target=work, args=(theirs, folder, worker, seed, -(-inputs // workers)))
            process.start()
            theirs.close()
            running[ours] = [process, time.monotonic() + 60.0, b""]
        while running:
            ready = wait(list(running), timeout=1.0)
            for pipe in list(running):
                process, due, last = running[pipe]
                try:
                    if pipe in ready:
                        outcome, content = pipe.recv()
                        _count(outcome, content, counts, failures)
                        running[pipe][1:] = [time.monotonic() + SECONDS, content]
                        if outcome == "done":
                            process.join()
                            del running[pipe]
                    elif time.monotonic() > due:
                        failures.append(f"hang: {_content(folder, last)!r}")
                        process.kill()
                        del running[pipe]
                except EOFError:
                    process.join()
                    failures.append(f"crash, exit {process.exitcode}: {_content(folder, last)!r}")
                    del running[pipe]
    return counts, failures


def _count(outcome: str, content: bytes, counts: Counter[str], failures: list[str]) -> None:
    if outcome in ("accepted", "refused"):
        counts[outcome] += 1
    elif outcome not in ("reading", "done"):
        counts["failed"] += 1
        failures.append(f"{outcome}\n{content[:2000]!r}")


def _content(folder: str, last: bytes | str) -> bytes:
    return (Path(folder) / last).read_bytes()[:20_000] if isinstance(last, str) else b"between two inputs"


def main() -> None:
    """The command line."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--inputs", type=int, default=20_000)
    options.add_argument("--workers", type=int, default=2)
    options.add_argument("--seed", type=int, default=1)
    given_options = options.parse_args()
    start = time.monotonic()
    counts, failures = fuzz(given_options.inputs, given_options.workers, given_options.seed)
    for failure in failures[:10]:
        print(failure, file=sys.stderr)
    print(f"{sum(counts.values())} inputs, {time.monotonic() - start:.0f} s, {dict(counts)}, {len(failures)} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
