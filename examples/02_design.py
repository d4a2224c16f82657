"""Compensators for one configuration by every method that fits it, and an asked frequency that does not exist."""

import warnings

import flexbase as fb

warnings.simplefilter("ignore", fb.FlexbaseWarning)  # the certificate holds the same words

pose = fb.load("ueda2003").at_tip([0.33, -0.25])
designs = {
    "the paper's recursion": fb.design(pose, method="recursive", natural_frequency=346.8),
    "exact, least gain": fb.design(pose, method="exact", natural_frequency=346.8),
    "exact, least radius": fb.design(pose, method="exact", natural_frequency=346.8, objective="least-radius"),
}
print(f"{'':22} {'w after':>10} {'omega':>9} {'rho':>6} {'mu':>6} {'lag margin':>11}")
for name, compensator in designs.items():
    facts = compensator.certificate
    print(
        f"{name:22} {facts.robustness_after[0]:10.1e} {facts.frequency_after_rad_s[0]:9.4f} "
        f"{facts.algebraic_loop_radius:6.3f} {facts.algebraic_loop_radius_per_joint:6.3f} "
        f"{1e3 * facts.lag_margin_s:8.3f} ms"
    )

print()
print(designs["exact, least gain"].summary())

print("\nAt 290 rad/s:")
try:
    fb.design(pose, natural_frequency=290.0)
except fb.Infeasible as answer:
    print(f"  {answer}")
