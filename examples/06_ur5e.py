"""A robot from a URDF: a UR5e on a steel pedestal that rocks, moved by MuJoCo. Needs the extras robots and convex."""

import warnings

import flexbase as fb

warnings.simplefilter("ignore", fb.FlexbaseWarning)  # the certificate holds the same words

plant = fb.load("ur5e-pedestal")
goal = plant.at_tip([0.72, -0.35, 1.3], "-+-")  # shoulder, elbow, wrist
start = plant.at_tip([0.67, -0.25, 1.3], "-+-", goal.joints)  # of many postures the one beside the goal's
print(fb.modes(goal).summary())

compensator = fb.design(goal, method="convex")
facts = compensator.certificate
print(f"\nrobustness {facts.robustness_before} -> {facts.robustness_after}")
print(f"algebraic-loop radius {facts.algebraic_loop_radius:.3f}, rightmost pole {facts.closed_loop_abscissa:.3f} 1/s")

print()
for used in (None, compensator):
    move = fb.Move(switch=0.2, end=0.4, interval=1e-3, engine="mujoco")
    run = fb.simulate(plant, start, goal, used, move=move)
    print(run.summary())
    late = run.error_size[run.t > run.t[-1] - 0.05].max()
    print(f"  largest tip error in the last 0.05 s: {1e3 * late:.3f} mm\n")

text = fb.to_mjcf(plant)  # the same machine for any program that reads MJCF
print(f"as MJCF: {len(text.splitlines())} lines, {text.count('<joint')} joint tags")
