"""In how many of 50 seeded poses a bundled robot on two base joints becomes positive real, and by which statement.

python benchmarks/shares.py [--radius 0.9] [--robots ur5e-pedestal ur5e-gantry] [--poses 50]

Two draws of the arm's joints: "bent", 0.2 to 1.5 rad either way; "anywhere", the whole turn, without the poses whose
smallest singular value of Jv is below a fiftieth of the largest. Slow: seconds for each pose that is refused.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections import Counter
from collections.abc import Iterator

import numpy as np

import flexbase as fb


def bent(plant: fb.Plant) -> Iterator[fb.Pose]:
    rng = np.random.default_rng(0)
    while True:
        yield plant.at(rng.uniform(0.2, 1.5, plant.arm.n) * rng.choice([-1.0, 1.0], plant.arm.n))


def anywhere(plant: fb.Plant) -> Iterator[fb.Pose]:
    rng = np.random.default_rng(0)
    while True:
        try:
            pose = plant.at(rng.uniform(-np.pi, np.pi, plant.arm.n))
        except fb.FlexbaseError:
            continue
        sizes = np.linalg.svd(pose.J[:, pose.arm.m :], compute_uv=False)
        if sizes[-1] > 0.02 * sizes[0]:
            yield pose


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--radius", type=float, default=0.9)
    parser.add_argument("--robots", nargs="+", default=["ur5e-pedestal", "ur5e-gantry"])
    parser.add_argument("--poses", type=int, default=50)
    options = parser.parse_args()
    warnings.simplefilter("ignore", fb.FlexbaseWarning)
    for robot in options.robots:
        for draw in (bent, anywhere):
            counts: Counter[str] = Counter()
            slowest, refused = 0.0, []
            for number, pose in zip(range(options.poses), draw(fb.load(robot)), strict=False):
                begin = time.perf_counter()
                proof = fb.design(pose, "convex", radius=options.radius).certificate
                slowest = max(slowest, time.perf_counter() - begin)
                if proof.algebraic_loop_radius > options.radius:
                    raise SystemExit(
                        f"control failed: {robot}, pose {number}: the radius is {proof.algebraic_loop_radius}"
                    )
                counts[proof.statement.split(":")[0]] += 1
                if not proof.statement.startswith("positive real"):
                    refused.append(number)
            shares = ", ".join(f"{name} {count}" for name, count in counts.most_common())
            print(
                f"{robot}, {draw.__name__}, rho <= {options.radius:g}: {shares}; "
                f"{slowest:.1f} s at most; without: {refused}"
            )


if __name__ == "__main__":
    main()
