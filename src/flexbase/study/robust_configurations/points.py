"""Robust arm configurations of any arm, as a set of points: samples of the joints, each brought to the nearest one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array, check_length
from flexbase.dynamics.inverse.newton import TipProblem
from flexbase.errors import InputError
from flexbase.measures import MEASURES
from flexbase.model.loop import Asked
from flexbase.plant import Plant
from flexbase.sheets.numbers import number
from flexbase.sheets.sheet import Column, Sheet, facts, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.study.robust_configurations.misalignment import TITLE, Misalignment, make_misalignment, tips_of
from flexbase.sweeps.answers.tables import write_rows
from flexbase.sweeps.engine.evaluate import Engine
from flexbase.sweeps.engine.formula import Formula
from flexbase.sweeps.engine.status import OK

COUNT, LARGEST = 1000, 1_000_000
STEPS = 60
LARGEST_STEP = 0.3  # rad or m
EXACT = 1e-10  # |a/|a| - b/|b|| of each mode asked for
MOST_DAMPING = 1e4
FLOOR = 1e-12  # of the Gram matrix, which may lose rank


@dataclass(frozen=True, eq=False)
class RobustPoints(Told):
    """Arm joints at which modes are positive real. Made by `robust_points`.

    modes : which modes are, from 1, slowest first
    joints, tip : shapes (P, n) and (P, k); alignment : of every mode, asked for or not, shape (P, m)
    distance : from the sample that each began as, shape (P,) [rad, m]
    samples : how many there were; nearest : where none arrived, the largest alignment of the worst mode asked for
    residual : largest |a/|a| - b/|b|| of a mode asked for
    """

    plant: Plant
    modes: tuple[int, ...]
    joints: Array
    tip: Array
    alignment: Array
    distance: Array
    samples: int
    nearest: float | None
    residual: float
    compensated: bool

    document: ClassVar = (
        "robot=plant.name",
        "modes",
        "compensated",
        "samples",
        "found",
        "residual",
        "nearest_alignment=nearest",
        "joints",
        "tip",
        "alignment",
    )

    @property
    def found(self) -> int:
        """How many postures there are."""
        return len(self.joints)

    def save_csv(self, path: str | Path) -> None:
        """A line a posture: joints, tip, alignment of each mode. Raises InputError."""
        arm = self.plant.arm
        header = [*arm.joint_names, *arm.task.rows, *(f"alignment_{i + 1}" for i in range(arm.m))]
        write_rows(path, header, np.hstack([self.joints, self.tip, self.alignment]).tolist())

    def sheet(self) -> Sheet:
        """How many postures there are, and how far their joints and tips reach."""
        arm, some = self.plant.arm, self.found > 0
        names = [*arm.joint_names, *(f"{row} of the tip" for row in arm.task.rows)]
        both = [*self.joints.T, *self.tip.T] if some else []
        return make_sheet(
            self.plant.name,
            TITLE,
            facts(
                ("modes", ", ".join(map(str, self.modes))),
                ("postures", f"{self.found} of {self.samples} samples"),
                ("largest |a/|a| - b/|b||", number(self.residual, 2)) if some else None,
                ("median way from the sample", number(float(np.median(self.distance)), 4)) if some else None,
                ("nearest alignment", number(self.nearest, 6)) if self.nearest is not None else None,
            ),
            table(
                [words("of the postures"), Column("least"), Column("largest")],
                ([name, number(min(v), 5), number(max(v), 5)] for name, v in zip(names, both, strict=False)),
            ),
        )


def robust_points(
    plant: Plant,
    modes: int | Sequence[int] | None = None,
    count: int = COUNT,
    *,
    bounds: Sequence[float] | None = None,
    loop: Asked = None,
) -> RobustPoints:
    """Postures in which some modes, or all, are positive real at once: |a/|a| - b/|b|| below 1e-10.  [theory §4]

    Low-discrepancy samples of the joints go to the set in damped Gauss-Newton steps of least length, with exact
    derivatives, so each ends near where it began. Each mode asked for takes k - 1 joints: what is left, n - (k - 1)
    times their number, is the dimension of the set. Where that is negative there are generally no such postures; a
    sample that does not arrive proves nothing. Postures in which the arm is singular are left out.

    modes : from 1, slowest first; all if left out
    count : of samples
    bounds : low, high of each arm joint in turn; a full turn, or the arm's reach, if left out. Samples begin there
    Raises InputError, MissingExtra (extra `fast`).
    """
    equations = make_misalignment(plant, loop)
    chosen = _modes(plant, modes)
    if not 1 <= count <= LARGEST:
        raise InputError(f"count: {count} samples, but 1 to {LARGEST} are taken.")
    starts = _samples(plant, count, bounds)
    joints, d = _projected(equations, starts, [mode - 1 for mode in chosen])
    error = np.linalg.norm(d[:, [mode - 1 for mode in chosen]], axis=2).max(axis=1)
    good = (error <= EXACT) & _regular(equations, joints)
    failed = error[~(error <= EXACT)]
    nearest = None if good.any() or not np.isfinite(failed).any() else float(1.0 - 0.5 * np.nanmin(failed) ** 2)
    kept = joints[good]
    wrapped = TipProblem(plant.arm.mechanism, plant.arm.task, plant.arm.base.equilibrium).wrapped(kept)
    return RobustPoints(
        plant,
        chosen,
        wrapped,
        tips_of(plant, kept),
        1.0 - 0.5 * (d[good] ** 2).sum(axis=2),
        np.linalg.norm(kept - starts[good], axis=1),
        count,
        nearest,
        float(error[good].max(initial=0.0)),
        equations.E is not None,
    )


def _projected(equations: Misalignment, starts: Array, modes: list[int]) -> tuple[Array, Array]:
    """Levenberg-Marquardt in steps of least length; rows with the smallest misalignment found, and that of all modes.

    The Gram matrix lacks one rank a mode at the solution; the damping, which falls with the error, stands in for it.
    """
    joints = starts.copy()
    every, slopes = equations(joints)
    d, J, length = _part(every, slopes, modes)
    damping = np.full(len(joints), 1e-3)
    active = np.flatnonzero(np.isfinite(length))
    for _ in range(STEPS):
        active = active[length[active] > 1e-14]
        if not active.size:
            break
        transposed = np.swapaxes(J[active], 1, 2)
        gram = J[active] @ transposed
        least = damping[active] * np.minimum(1.0, length[active]) + FLOOR * (1.0 + np.trace(gram, axis1=1, axis2=2))
        gram += least[:, None, None] * np.eye(J.shape[1])
        step = -(transposed @ np.linalg.solve(gram, d[active][..., None]))[..., 0]
        step *= np.minimum(1.0, LARGEST_STEP / np.maximum(np.abs(step).max(axis=1), 1e-300))[:, None]
        trial = joints[active] + step
        trial_every, trial_slopes = equations(trial)
        trial_d, trial_J, trial_length = _part(trial_every, trial_slopes, modes)
        better = trial_length < length[active]
        rows = active[better]
        joints[rows], every[rows], d[rows], J[rows] = (
            trial[better],
            trial_every[better],
            trial_d[better],
            trial_J[better],
        )
        length[rows] = trial_length[better]
        damping[active] = np.where(better, 0.1 * damping[active], 10.0 * damping[active])
        active = active[damping[active] <= MOST_DAMPING]
    return joints, every


def _part(d: Array, slopes: Array, modes: list[int]) -> tuple[Array, Array, Array]:
    """The equations of some modes in one row, shape (S, c), their slopes (S, c, n), and their lengths (S,)."""
    S, n = len(d), slopes.shape[-1]
    part = d[:, modes].reshape(S, -1)
    return part.copy(), slopes[:, modes].reshape(S, -1, n).copy(), np.linalg.norm(part, axis=1)


def _modes(plant: Plant, modes: int | Sequence[int] | None) -> tuple[int, ...]:
    m = plant.arm.m
    if modes is None:
        return tuple(range(1, m + 1))
    chosen = (modes,) if isinstance(modes, int) else tuple(modes)
    for mode in chosen:
        if not 1 <= mode <= m:
            raise InputError(f"modes: {plant.name} has no mode {mode}. Give 1 to {m}, slowest first.")
    if not chosen:
        raise InputError(f"modes: none given. Give some of 1 to {m}, or leave them out for all.")
    return tuple(sorted(set(chosen)))


def _samples(plant: Plant, count: int, bounds: Sequence[float] | None) -> Array:
    from scipy.stats import qmc  # half a second to import

    arm = plant.arm
    window = np.array(arm.parts.arm(arm.mechanism.ranges))
    if bounds is not None:
        window = check_length("bounds", bounds, 2 * arm.n, "low, high of each arm joint in turn").reshape(-1, 2)
    low, high = window.T
    if not (low <= high).all():
        raise InputError(
            f"bounds: {window.ravel().tolist()} are not low, high, low, high. Give each low below its high."
        )
    return np.asarray(low + (high - low) * qmc.Halton(arm.n, scramble=False).random(count + 1)[1:])


def _regular(equations: Misalignment, joints: Array) -> NDArray[np.bool_]:
    """Rows whose arm is not singular and whose inertia is definite, shape (S,)."""
    arm = equations.arm
    question = Formula(arm, (MEASURES["alignment"],), tuple(range(arm.n)), (0.0,) * arm.n, E=equations.E)
    return np.asarray(Engine(question).run(np.ascontiguousarray(joints.T)).status == OK)
