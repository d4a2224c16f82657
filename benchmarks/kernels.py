"""The compiled kernel, joints in memory to robustness out, against what else there is. One thread each."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import cache

import numpy as np
from controls import allowance, must_agree, must_be_slower, scalar_path
from models import PANDA1, PLANTS, joints, plant, robustness_of
from pinocchio_loop import pipeline
from timing import Ratio, Side, race

from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import forward, task_jacobian
from flexbase.measures import Configuration
from flexbase.measures.robustness import robustness
from flexbase.sweeps.engine.evaluate import Engine, compiled
from flexbase.trace.kernel import Kernel, cores, kernel_of

MANY = 1 << 18  # configurations that a kernel gets at once
SOME = 1 << 14  # that the slow ways get
FEW = 200  # that are compared with the scalar path
ENOUGH = 1.8  # cores that two threads must have had
STORED = 1.5  # a kernel that only writes M and J to memory, for NumPy to go on with, takes at least so much longer


@cache
def kernel(name: str) -> Kernel:
    """The kernel of a plant's question, after its controls."""
    question = robustness_of(name)
    made = compiled(question).kernel
    assert made is not None
    cells = joints(name, FEW, seed=1)
    answers = made(cells, threads=1)[1:]
    must_agree(f"{name}, kernel", answers, scalar_path(question, cells), allowance(plant(name), cells))
    return made


def vs_pinocchio_loop() -> list[Ratio]:
    """Poses a second a thread against the loop over Pinocchio, on the same configurations."""
    return [_vs_pinocchio_loop(name) for name in PLANTS]


def _vs_pinocchio_loop(name: str) -> Ratio:
    made, loop, many = kernel(name), pipeline(plant(name).arm), joints(name, MANY)
    some = np.ascontiguousarray(many[:, :SOME])
    must_agree(f"{name}, Pinocchio", loop(some), made(some)[1:], allowance(plant(name), some))
    out = np.empty((made.outputs, MANY))
    fast = Side(lambda: made(many, out, threads=1), times=5, work=MANY)
    return race(f"{name}_vs_pinocchio_loop", fast, "a loop over Pinocchio, then NumPy rows", Side(
        lambda: loop(some), work=SOME
    ))  # fmt: skip


def panda1_vs_numpy_rows() -> list[Ratio]:
    """The same question by NumPy rows; and, as a control, a kernel that stores M and J instead of using them."""
    made, many = kernel(PANDA1), joints(PANDA1, MANY)
    some = np.ascontiguousarray(many[:, :SOME])
    rows, stored = Engine(robustness_of(PANDA1)), _storing_kernel()
    must_agree("NumPy rows", rows.run(some).values["robustness"].T, made(some)[1:], allowance(plant(PANDA1), some))
    must_agree("the storing kernel", stored(some), made(some)[1:], allowance(plant(PANDA1), some))
    out = np.empty((made.outputs, MANY))
    fast = Side(lambda: made(many, out, threads=1), times=5, work=MANY)
    by_rows = race("panda1_vs_numpy_rows", fast, "NumPy rows", Side(lambda: rows.run(some), work=SOME))
    wasteful = race(
        "panda1_vs_stored_matrices",
        fast,
        "a kernel for M and J, then NumPy rows",
        Side(lambda: stored(some), work=SOME),
    )
    must_be_slower("storing M and J", wasteful.ratio, STORED)
    must_be_slower("NumPy rows", by_rows.ratio, STORED)
    return [by_rows, wasteful]


def _storing_kernel():  # type: ignore[no-untyped-def]
    """The waste that fusing avoids: M and J of every configuration through memory."""
    arm = plant(PANDA1).arm
    N, k = arm.N, arm.k
    rest = tuple(arm.base.equilibrium.tolist())

    def matrices(cell):  # type: ignore[no-untyped-def]
        frames = forward(arm.mechanism, (*rest, *cell))
        rows = (*mass_matrix(frames), *task_jacobian(frames, arm.task.indices))
        return [entry for row in rows for entry in row]

    made = kernel_of(matrices, arm.n, "benchmark: M and J of panda1")

    def run(cells: np.ndarray) -> np.ndarray:
        stored = made(cells, threads=1).reshape(N + k, N, -1)
        configuration = Configuration(
            tuple(map(tuple, stored[:N])),
            tuple(map(tuple, stored[N:])),
            arm.parts,
            arm.base.stiffness.tolist(),
            arm.base.damping.tolist(),
        )
        return np.array([robustness(mode) for mode in configuration.modes])

    return run


def panda1_two_threads_vs_one() -> list[Ratio]:
    """The same cells by two threads and by one. Left out where there is one core."""
    if cores() < 2:
        return []
    made, cells = kernel(PANDA1), joints(PANDA1, 8 * MANY)
    one, two = np.empty((2, made.outputs, 8 * MANY))
    if not np.array_equal(made(cells, one, threads=1), made(cells, two, threads=2)):
        raise SystemExit("control failed: two threads give other bits than one")
    both, single = (
        Side(lambda: made(cells, two, threads=2), times=2),
        Side(lambda: made(cells, one, threads=1), times=2),
    )
    result, got = race("panda1_two_threads_vs_one", both, "one thread", single), cores_got(both.call)
    if got < ENOUGH:
        print(f"two threads got {got:.2f} cores, because other programs run: the next ratio says nothing of the kernel")
    return [result]


def cores_got(call: Callable[[], object], times: int = 5) -> float:
    """Processor time over wall time: how many cores the system left to this process."""
    wall, own = time.perf_counter(), time.process_time()
    for _ in range(times):
        call()
    return (time.process_time() - own) / (time.perf_counter() - wall)
