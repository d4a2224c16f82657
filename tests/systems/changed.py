"""Plants whose own arrays hold what a sweep's parameters stand for: the witness of parameters."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import flexbase as fb
from flexbase.model.base import make_base


def changed(plant: fb.Plant, name: str, value: float) -> fb.Plant:
    """The plant with one parameter written into its arrays: links rebuilt, springs scaled by diag(sqrt f)."""
    arm = plant.arm
    kind, _, joint = name.partition(".")
    chosen = np.array([not joint or joint == one for one in arm.mechanism.joint_names])
    base, mechanism = arm.base, arm.mechanism
    if kind in ("stiffness", "damping"):
        root = np.diag(np.where(chosen[: arm.m], np.sqrt(value), 1.0))
        K = root @ base.stiffness @ root if kind == "stiffness" else base.stiffness
        D = root @ base.damping @ root if kind == "damping" else base.damping
        base = make_base(K, D, base.equilibrium, arm.m)
    elif kind == "payload":
        mass, com, inertia = mechanism.mass.copy(), mechanism.com.copy(), mechanism.inertia.copy()
        tip, own = mechanism.tool_position, com[-1].copy()
        mass[-1] += value
        com[-1] = (mechanism.mass[-1] * own + value * tip) / mass[-1]
        for weight, place in ((mechanism.mass[-1], own), (value, tip)):
            gap = place - com[-1]
            inertia[-1] = inertia[-1] + weight * (gap @ gap * np.eye(3) - np.outer(gap, gap))
        mechanism = replace(mechanism, mass=mass, com=com, inertia=inertia)
    else:
        chosen[: arm.m] = False
        factor = np.where(chosen, value, 1.0)
        if kind == "link_mass":
            mass, inertia = factor * mechanism.mass, factor[:, None, None] * mechanism.inertia
            mechanism = replace(mechanism, mass=mass, inertia=inertia)
        else:
            mechanism = replace(mechanism, com=factor[:, None] * mechanism.com)
    return fb.Plant(replace(arm, base=base, mechanism=mechanism))
