"""Units of joint and task stiffness and damping, as messages write them."""

UNIT = "N/m (or N m/rad)"
DAMPING_UNIT = "N s/m (or N m s/rad)"
