"""Postures found instead of looked up: how to stand on a target, where arms are robust, where to put the work."""

from pathlib import Path

import flexbase as fb

plant = fb.load("ueda2003")
print(fb.postures(plant, [0.33, -0.25]).summary())
print(fb.robust_curves(plant).summary())

holes = [[0.33, -0.25], [0.33, -0.10], [0.45, -0.10], [0.45, -0.25]]
layout = fb.layout(plant, holes, within=0.15)
print(layout.summary())

arm = fb.load("ur5e-pedestal")
found = fb.postures(arm, [0.4, 0.2, 1.0])
print(f"\n{arm.name}: w = {found.best.value:.2g} of the worst mode, instead of {found.usual.value:.2g}")
print(fb.modes(found.best.pose).summary())
print(fb.robust_points(arm, modes=1, count=500).summary())

out = Path("out/examples")
out.mkdir(parents=True, exist_ok=True)
for name, result in {"posture": found, "layout": layout}.items():
    fb.plot(result).savefig(out / f"{name}.png")
print(f"\nPictures: {out}")
