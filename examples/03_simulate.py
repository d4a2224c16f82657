"""The same move without and with a compensator: 0.1 s of joint tracking, then the task-space loop."""

import flexbase as fb

plant = fb.load("ueda2003")
start, goal = plant.at_tip([0.33, 0.25]), plant.at_tip([0.33, -0.25])
compensator = fb.design(goal, natural_frequency=346.8)

for used in (None, compensator):
    run = fb.simulate(plant, start, goal, used)
    print(run.summary())
    print("  tip error by time after switching:")
    for after in (0.05, 0.10, 0.20, 0.30):
        sample = abs(run.t - (run.switch + after)).argmin()
        print(f"    {after:4.2f} s  {1e3 * run.error_size[sample]:10.6f} mm")
    print()
