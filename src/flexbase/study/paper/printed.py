"""What the paper prints, as it prints it.  [U03 Table I, eq 17, §IV]"""

from __future__ import annotations

import numpy as np

INERTIA = np.array([[0.58, 0.013], [0.013, 0.104]])  # Mhat [kg m^2]
RESIDUE_BEFORE = np.array([[-0.032, -0.075], [0.037, 0.085]])  # R_1 of eq 17, left [m/(N s^2)]
RESIDUE_AFTER = np.array([[0.036, 0.048], [0.05, 0.066]])  # R_1 of eq 17, right
GAIN = np.array([[0.12, 0.079], [0.079, -0.15]])  # E [kg m^2]

TABLE_I: dict[str, tuple[float, float, float]] = {  # one value a link, base first
    "m [kg]": (20.0, 7.0, 5.0),
    "I [kg m²]": (0.066, 0.0525, 0.026),
    "l [m]": (0.2, 0.3, 0.25),
    "lg [m]": (0.02, 0.15, 0.125),
}
STIFFNESS = 3.0e4  # kp1 [N m/rad]
DAMPING = 10.0  # kv1 [N m s/rad]
