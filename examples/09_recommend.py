"""From positive real to running: what becomes of the paper's compensator in a sampled loop, and what runs instead."""

from pathlib import Path

import flexbase as fb

# The paper's pose: ideal acceleration makes the plant positive real ...
pose = fb.load("ueda2003").at_tip([0.33, -0.25])
compensator = fb.design(pose, method="exact", natural_frequency=346.8)
print(f"ideal loop: positive real with E is {fb.modes(pose, compensator).positive_real}")

# ... and one sample of delay on either side takes it away, at the rates that robots have.
for rate in (1000.0, 4000.0):
    for method in ("none", "exact", "robust"):
        controller = fb.make_controller(pose, method, fb.Loop(sensing=fb.Sensing(rate=rate)))
        print(fb.hardware_verdict(controller, brief=True).summary())

# Six lines to act on, for the paper's arm, a gantry arm and a UR5e on its mobile platform.
gantry = fb.load(Path(__file__).with_name("gantry.toml"))
for here in (pose, gantry.at_tip([0.6, 0.3, 0.3]), fb.load("ur5e-platform").at([0.0, -1.2, 1.6, -0.4, 1.5, 0.0])):
    print(f"\n{here.plant.name} at {here.tip.round(3).tolist()}")
    print(fb.recommend(here, methods=("none", "coprime", "robust")).summary())
