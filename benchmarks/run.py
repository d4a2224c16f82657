"""Run all benchmarks and print ratios; write them to out/bench.json. Absolute times are not reported: machines differ.

python benchmarks/run.py [--save FILE] [--compare FILE]
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from designs import exact_vs_recursion
from maps import rows_vs_poses

ALL = (exact_vs_recursion, rows_vs_poses)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--save", type=Path, help="write the ratios to this file too")
    parser.add_argument("--compare", type=Path, help="print each ratio beside the one saved in this file")
    options = parser.parse_args()
    saved = {}
    if options.compare:
        saved = {entry["name"]: entry["ratio"] for entry in json.loads(options.compare.read_text("utf-8"))}
    results = []
    for benchmark in ALL:
        for result in benchmark():
            results.append(result._asdict())
            before = f"  (saved: {saved[result.name]:.3g})" if result.name in saved else ""
            low, high = result.spread
            print(f"{result.name}: {result.ratio:.3g} x {result.against}, {low:.3g} to {high:.3g}{before}")
    for target in filter(None, (Path("out/bench.json"), options.save)):
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(json.dumps(results, indent=2) + "\n", "utf-8")


if __name__ == "__main__":
    main()
