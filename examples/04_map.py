"""Maps over the workspace: where the arm is robust, and where a compensator can make it so."""

from pathlib import Path

import numpy as np

import flexbase as fb

plant = fb.load("ueda2003")
chart = fb.sweep(plant, measures=["robustness", "compensability"], cells=fb.Cells(over="tip", shape=(200, 200)))
print(fb.summary(chart))

reached = chart.status == 0
compensable = chart.compensability.values[reached] > 0.0
print(f"  compensable: {100.0 * np.mean(compensable):.0f} % of the workspace")

robustness = chart.robustness.values[..., 0]
print("\nDistance from the robust arm configuration, 0 (near) to 9 (far), y upwards:")
for row in range(len(robustness) - 1, -1, -12):
    levels = np.minimum(9.99, 10.0 * robustness[row, ::6] / np.nanmin(robustness))
    print("  " + "".join(" " if np.isnan(level) else str(int(level)) for level in levels))

pose = plant.at_tip([0.33, -0.25])
compensated = fb.sweep(
    plant,
    measures=["robustness"],
    loop=fb.design(pose, method="exact", natural_frequency=346.8),
    cells=fb.Cells(shape=(200, 200)),
)
change = fb.difference(chart, compensated)  # of what both have
print(f"\nWith a compensator for one pose:\n{fb.summary(change)}")

out = Path("out/examples")
out.mkdir(parents=True, exist_ok=True)
fb.save_csv(chart, out / "map.csv")
fb.save_plot(chart, out / "map.png")
fb.save_plot(change, out / "change.png")  # with plotly, a name that ends in .html gives an interactive page
print(f"\nWritten to {out}: map.csv, map.png, change.png")
