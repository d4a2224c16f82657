"""The kernel's rate against what the processor does in a matrix product.

Counted by the model, 1.7 kflop a Panda pose, which is what M and J take by the textbook; not by what the kernel does.
"""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
from kernels import MANY, kernel
from models import PANDA1, joints
from timing import Ratio, Side, median

POSE = 1700.0  # floating-point operations a Panda pose
SIZE, BEST_OF, ROUNDS = 2000, 3, 9
WIDE = "SkylakeX"  # OpenBLAS's own name for its AVX-512 code, which it does not choose on every processor that has it

PRODUCT = f"""
import time, numpy as np
A, B = np.random.default_rng(0).random((2, {SIZE}, {SIZE}))
A @ B
for _ in range({ROUNDS}):
    input()
    times = []
    for _ in range({BEST_OF}):
        begin = time.perf_counter(); A @ B; times.append(time.perf_counter() - begin)
    print(2.0 * {SIZE} ** 3 / min(times), flush=True)
"""


def panda1_fraction_of_dgemm() -> list[Ratio]:
    """Against NumPy's matrix product as installed, and against OpenBLAS told to use AVX-512, where that is faster."""
    made, cells = kernel(PANDA1), joints(PANDA1, MANY)
    out = np.empty((made.outputs, MANY))
    poses = Side(lambda: made(cells, out, threads=1), times=20, work=MANY)
    poses.call()
    installed = _rounds(poses, {})
    wide = _rounds(poses, {"OPENBLAS_CORETYPE": WIDE})
    results = [median("panda1_fraction_of_dgemm", "one-thread dgemm of NumPy as installed", installed)]
    if np.median(wide) < 0.9 * np.median(installed):
        results.append(median("panda1_fraction_of_avx512_dgemm", f"one-thread dgemm of OpenBLAS as {WIDE}", wide))
    return results


def _rounds(poses: Side, environment: dict[str, str]) -> list[float]:
    """A ratio of rates a round; the products run in a process of their own, which waits meanwhile."""
    settings = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", **environment}
    command = [sys.executable, "-c", PRODUCT]
    with subprocess.Popen(command, env=settings, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdin is not None
        assert child.stdout is not None
        ratios = []
        for _ in range(ROUNDS):
            child.stdin.write("\n")
            child.stdin.flush()
            product = float(child.stdout.readline())
            ratios.append(POSE / poses.seconds() / product)
    return ratios
