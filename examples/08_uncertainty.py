"""How sure is a design when stiffness, payload and masses are known to some percent only?"""

from pathlib import Path

import flexbase as fb

plant = fb.load("ueda2003")
pose = plant.at_tip([0.33, -0.25])
E = fb.design(pose, method="exact", natural_frequency=346.8)
vary = {"stiffness": fb.Normal(1.0, 0.15), "payload": fb.Uniform(0.0, 3.0), "link_mass": fb.Lognormal(1.0, 0.05)}

at_pose = fb.montecarlo(pose, fb.Draws(vary, samples=5000), loop=E, criteria=["definite", "robust", "stable", "loop"])
print(at_pose.summary())
for name, one in at_pose.by_criterion.items():
    print(f"    {name}: {one.value:.3f} ({one.lower:.3f} to {one.upper:.3f})")

fails = at_pose.dataset["share"] == 0
for name in vary:
    drawn = at_pose.dataset[name]
    print(f"    {name}: mean {float(drawn.mean()):.3f}, where it fails {float(drawn[fails].mean()):.3f}")

chart = fb.montecarlo(plant, vary, redesign=True)
print("\nThe same over the workspace, with the exact design of each cell:")
print(chart.summary())

out = Path("out/examples")
out.mkdir(parents=True, exist_ok=True)
for name, result in {"probability_at_pose": at_pose, "probability": chart}.items():
    fb.plot(result).savefig(out / f"{name}.png")
chart.save_netcdf(out / "probability.nc")
print(f"\nPictures and numbers: {out}")
