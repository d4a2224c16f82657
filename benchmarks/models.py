"""The three plants of the benchmarks, and joint angles to ask about."""

from __future__ import annotations

import shutil
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

import flexbase as fb
from flexbase.measures import MEASURES
from flexbase.sweeps.engine.formula import Formula

HERE = Path(__file__).parent
ROBOTS = Path(fb.__file__).parent / "model" / "library" / "robots"
PLANAR3R, PANDA1, PANDA3 = "planar3r", "panda1", "panda3"
PLANTS = (PLANAR3R, PANDA1, PANDA3)


@cache
def plant(name: str) -> fb.Plant:
    """planar3r: the paper's arm, three joints in all, the first of them the base. panda1, panda3: seven arm joints on
    a base of one or three."""
    if name == PLANAR3R:
        return fb.load("ueda2003")
    if name == PANDA3:
        return fb.load("panda-platform")
    with tempfile.TemporaryDirectory() as folder:  # a project's robot file lies in its own folder
        shutil.copy(ROBOTS / "panda.urdf", folder)
        shutil.copy(HERE / "data" / "panda1.toml", folder)
        return fb.load(Path(folder) / "panda1.toml")


def robustness_of(name: str) -> Formula:
    """Joints in, status and the robustness of every mode out: what `flexbase sweep --over joints` asks."""
    arm = plant(name).arm
    return Formula(arm, (MEASURES["robustness"],), tuple(range(arm.n)), (0.0,) * arm.n)


def joints(name: str, cells: int, seed: int = 0) -> np.ndarray:
    """Arm joints all over the turn, shape (n, cells) [rad]."""
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (plant(name).arm.n, cells))
