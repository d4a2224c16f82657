"""The exact verdict of 1000 random plants against a dense sweep of each: errors, false answers, time.

python benchmarks/verdicts.py [--plants 1000] [--seed 0]

m to 3 base joints, k to 6 rows, damping that couples the modes. A quarter each: V unrelated to U, aligned with it,
nearly aligned, turned. Takes minutes: the sweep is a thousand frequencies around every pole, and zooms. No ratio, so
not part of `make bench`.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

import flexbase as fb

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from systems.dense_sweep import KINDS, grid, random_plant, shortage_and_gain

TOLERANCE = 1e-8  # of the largest gain, as in the verdict


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plants", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    errors, gains, answers, wrong, unsettled, spent = [], [], [], 0, 0, 0.0
    for i in range(options.plants):
        m, k = int(rng.integers(1, 4)), int(rng.integers(1, 7))
        plant = random_plant(rng, m, k, KINDS[i % len(KINDS)])
        system = fb.SecondOrder(plant.S, plant.D, plant.K, -plant.V.T, plant.U, ("q",) * m, ("f",) * k, ("y",) * k)
        begin = time.perf_counter()
        found = fb.verdict(system)
        spent += time.perf_counter() - begin
        nu, gain = shortage_and_gain(plant.response, grid(plant.poles()))
        errors.append(abs(found.shortage - nu) / gain)
        gains.append(abs(found.largest_gain / gain - 1.0))
        answers.append(found.positive_real)
        wrong += found.positive_real != (nu >= -TOLERANCE * gain)
        unsettled += any("settle" in caveat for caveat in found.caveats)
    if not 0 < sum(answers) < len(answers):
        raise SystemExit("control failed: a constant answer would pass")
    print(f"{len(answers)} plants, {sum(answers)} positive real, {1e3 * spent / len(answers):.1f} ms a verdict")
    print(f"error of nu, of the largest gain: {max(errors):.2g} at most, {np.median(errors):.2g} in the median")
    print(f"relative error of the largest gain: {max(gains):.2g} at most")
    print(f"false answers: {wrong}; searches that did not settle: {unsettled}")
    sys.exit(bool(wrong or max(errors) > TOLERANCE))


if __name__ == "__main__":
    main()
