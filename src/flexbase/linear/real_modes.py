"""Undamped mode shapes of the reduced form, for one configuration or a batch: what maps are made of."""

from __future__ import annotations

import numpy as np

from flexbase.linear.reduced import RealMode, Reduced, shaped_mode, single_mode
from flexbase.model.base import Base
from flexbase.trace.algebra import stack, unstack


def real_modes(reduced: Reduced, base: Base) -> tuple[RealMode, ...]:
    """Modes with real shapes, slowest first.

    Exact for one base joint and for proportional damping; otherwise the modes of the undamped base, each with the
    damping that its own shape meets. Assumes S positive definite in every configuration.
    """
    if base.m == 0:
        return ()
    if base.m == 1:
        return (single_mode(reduced, float(base.stiffness[0, 0]), float(base.damping[0, 0])),)
    inverse = np.linalg.inv(np.linalg.cholesky(stack(reduced.S)))
    stiffness, turned = np.linalg.eigh(inverse @ base.stiffness @ np.swapaxes(inverse, -1, -2))
    shapes = np.swapaxes(inverse, -1, -2) @ turned
    damping = np.einsum("...ji,jk,...ki->...i", shapes, base.damping, shapes)
    return tuple(
        shaped_mode(reduced, unstack(shapes[..., i], 1), unstack(stiffness[..., i], 0), unstack(damping[..., i], 0))
        for i in range(base.m)
    )
