"""The vibration modes of an arm on its base, in two configurations: far from the robust one, and near it."""

import flexbase as fb

plant = fb.load("ueda2003")
for target in ([0.33, -0.25], [0.33, 0.25]):
    pose = plant.at_tip(target)
    modes = fb.modes(pose)
    print(modes.summary())
    print(f"  residue R_1 = {modes[0].residue.round(6).tolist()}\n")
