"""What every ratio has to pass first: right answers, and a check that wrong ones fail."""

from __future__ import annotations

import numpy as np

from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import forward
from flexbase.plant import Plant
from flexbase.sweeps.engine.formula import Formula
from flexbase.trace.algebra import stack

ROUNDING = 1e-12  # times the condition number of M, of the largest value of the batch


def scalar_path(question: Formula, joints: np.ndarray) -> np.ndarray:
    """The same question on plain floats, one configuration after the other, shape (values, cells)."""
    return np.array([question(tuple(cell))[1:] for cell in joints.T.tolist()]).T


def allowance(plant: Plant, joints: np.ndarray) -> np.ndarray:
    """1e-12 cond(M) in every configuration: what rounding in M may cost."""
    rest = plant.arm.base.equilibrium[:, None] + np.zeros((plant.arm.m, joints.shape[1]))
    M = stack(mass_matrix(forward(plant.arm.mechanism, (*rest, *joints))))
    return ROUNDING * np.linalg.cond(M)


def agree(values: np.ndarray, truth: np.ndarray, allowed: np.ndarray) -> bool:
    """Whether all values are right, against the largest of the batch: robustness may vanish."""
    return bool(np.all(np.abs(values - truth) <= allowed * np.abs(truth).max()))


def must_agree(name: str, values: np.ndarray, truth: np.ndarray, allowed: np.ndarray) -> None:
    """End the run unless the values are right, and unless wrong kernels would be found out."""
    if not agree(values, truth, allowed):
        raise SystemExit(f"control failed: {name} gives wrong answers")
    wrong = {
        "a null kernel": np.zeros_like(values),
        "a constant": np.full_like(values, truth.mean()),
        "the neighbour's answers": np.roll(values, 1, axis=-1),
        "single precision": values.astype(np.float32).astype(float),
    }
    for kind, answers in wrong.items():
        if agree(answers, truth, allowed):
            raise SystemExit(f"control failed: {kind} would pass for {name}")


def must_be_slower(what: str, ratio: float, least: float) -> None:
    """End the run unless a wasteful kernel shows."""
    if ratio < least:
        raise SystemExit(f"control failed: {what} costs only {ratio:.2f} times the kernel; at least {least:g} expected")
