"""Run all benchmarks and print ratios; write them to out/bench.json. Absolute times are not reported: machines differ.

python benchmarks/run.py [--save FILE] [--compare FILE] [--only WORD ...]
"""

from __future__ import annotations

import argparse
import json
import os
from pathlib import Path

os.environ.update(OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1", OMP_NUM_THREADS="1")  # before NumPy: one thread each

from designs import exact_vs_recursion
from first_call import panda1_first_call
from kernels import panda1_two_threads_vs_one, panda1_vs_numpy_rows, vs_pinocchio_loop
from maps import map_rows_vs_poses
from matrix_product import panda1_fraction_of_dgemm
from mujoco_batch import panda1_vs_mujoco_batch
from simulations import simulate_many_vs_simulate, simulate_vs_mujoco

ALL = (
    vs_pinocchio_loop,
    panda1_vs_numpy_rows,
    panda1_vs_mujoco_batch,
    panda1_fraction_of_dgemm,
    panda1_two_threads_vs_one,
    panda1_first_call,
    exact_vs_recursion,
    simulate_vs_mujoco,
    simulate_many_vs_simulate,
    map_rows_vs_poses,
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--save", type=Path, help="write the ratios to this file too")
    parser.add_argument("--compare", type=Path, help="print each ratio beside the one saved in this file")
    parser.add_argument(
        "--only", nargs="+", choices=[one.__name__ for one in ALL], help="run these alone; no bench.json"
    )
    options = parser.parse_args()
    saved = {}
    if options.compare:
        saved = {entry["name"]: entry["ratio"] for entry in json.loads(options.compare.read_text("utf-8"))}
    results = []
    for benchmark in ALL:
        if options.only and benchmark.__name__ not in options.only:
            continue
        for result in benchmark():
            results.append(result._asdict())
            before = f"  (saved: {saved[result.name]:.3g})" if result.name in saved else ""
            low, high = result.spread
            print(f"{result.name}: {result.ratio:.3g} x {result.against}, {low:.3g} to {high:.3g}{before}", flush=True)
    for target in filter(None, (None if options.only else Path("out/bench.json"), options.save)):
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(json.dumps(results, indent=2) + "\n", "utf-8")


if __name__ == "__main__":
    main()
