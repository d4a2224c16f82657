"""Modal analysis of a pose: frequencies, damping, residues, the distance from positive realness.  [theory §3, §4]"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from flexbase.cautions import caution, collected
from flexbase.checks import Array
from flexbase.linear.linearise import (
    ReducedArrays,
    check_definite_inertia,
    is_reducible,
    linearise,
    reduced_arrays,
)
from flexbase.linear.quadratic_eigenproblem import Pole, RealShapes, damped_poles, real_shapes
from flexbase.linear.reduced import RealMode, alignment, robustness
from flexbase.model.loop import Asked, Gain, loop_on
from flexbase.model.mounted import MountedArm
from flexbase.plant import Pose, check_pose
from flexbase.sheets.numbers import matrix, number
from flexbase.sheets.plain import Plain
from flexbase.sheets.sheet import Column, Sheet, answer, facts, make_sheet, table, words
from flexbase.sheets.told import Told

POSITIVE_REAL = 1e-8  # relative passivity shortage (1 - cos)/2 up to which a residue counts as positive  [theory §5]
VANISHING = 1e-12  # a mode that the tip sees or drives less than this, relative, is out of its reach
ONE_JOINT = "One base joint: exact, at any damping."
UNDAMPED = "Undamped base: exact in the limit of vanishing damping."
PROPORTIONAL = "Proportional damping: positive residues are sufficient, not necessary; `verdict` is exact."
INDICATOR = "Non-proportional damping: residues neither necessary nor sufficient, an indicator; `verdict` is exact."
ONE_BETA = "V = beta Jp with one beta outside (0, 1): positive real at any damping of the base."
COUPLED = "Gravity stiffness or joint friction couples arm and base: an indicator only; `verdict` is exact."
RIGID = "Rigid base: no vibration mode."


@dataclass(frozen=True, eq=False)
class Mode(Plain):
    """One vibration mode: (R' s + R) / (s^2 + 2 zeta omega s + omega^2) in P(s).  [U03 eq 5-7, theory §3]

    frequency : omega = |l| [rad/s]
    damping_ratio : zeta; above 1 the two poles are real
    residue : R, shape (k, k)
    residue_s : R', zero when the damping is proportional, shape (k, k)
    robustness : w = lambda_min(R + R^T)  [U03 eq 9]
    alignment : cos(a, b) for R = a b^T; trace(R) over the sum of its singular values otherwise; None if R = 0
    shape : joint displacements, largest one 1, shape (N,), complex when damping is not proportional
    participation : share of each base joint in the mode's strain energy, shape (m,)
    label : the base joints that take part most
    """

    frequency: float
    damping_ratio: float
    residue: Array
    residue_s: Array
    robustness: float
    alignment: float | None
    shape: np.ndarray
    participation: Array
    label: str

    document: ClassVar = (
        "frequency_rad_s=frequency",
        "damping_ratio",
        "residue",
        "residue_s",
        "robustness",
        "alignment",
        "label",
        "participation",
    )

    def row(self) -> tuple[str, ...]:
        """The mode in a line: what takes part, frequency in both units, damping ratio, robustness, alignment."""
        hertz, damping = number(self.frequency / (2.0 * np.pi), 6), number(self.damping_ratio, 6)
        return self.label, number(self.frequency), hertz, damping, number(self.robustness), number(self.alignment)


COLUMNS = (
    words("mode"),
    Column("frequency", "rad/s"),
    Column("", "Hz"),
    Column("damping\nratio"),
    Column("robustness w", "m/(N s^2)"),
    Column("alignment", "1"),
)


@dataclass(frozen=True, eq=False)
class Modes(Told):
    """All vibration modes of a pose, slowest first, and the rigid mode.

    rigid_mode : R_0, shape (k, k)  [U03 eq 6]
    positive_real : the simple verdict by residues; `caveat` says how far it may be trusted
    compensated : whether a compensator is at work
    cautions : what should be known of the loop and of the modes
    """

    pose: Pose
    modes: tuple[Mode, ...]
    rigid_mode: Array
    positive_real: bool
    caveat: str
    compensated: bool
    cautions: tuple[str, ...] = ()

    document: ClassVar = (
        "q=pose.q",
        "tip=pose.tip",
        "modes",
        "rigid_mode",
        "positive_real",
        "positive_real_caveat=caveat",
    )

    def __len__(self) -> int:
        return len(self.modes)

    def __getitem__(self, index: int) -> Mode:
        return self.modes[index]

    def sheet(self) -> Sheet:
        """A row a mode, the residues, and the verdict."""
        damped = any(mode.residue_s.any() for mode in self.modes)
        residues = [
            row
            for i, mode in enumerate(self.modes, start=1)
            for row in (
                (f"R_{i} [m/(N s^2)]", matrix(mode.residue)),
                (f"R'_{i} [m/(N s)]", matrix(mode.residue_s)) if damped else None,
            )
        ]
        return make_sheet(
            self.pose.plant.name,
            f"vibration modes {'with' if self.compensated else 'without'} compensator",
            self.pose.where,
            table(COLUMNS, (mode.row() for mode in self.modes)),
            facts(*residues, ("R_0 [m/(N s^2)]", matrix(self.rigid_mode))),
            answer(self.positive_real, "Positive real", "Not positive real", self.caveat),
            cautions=self.cautions,
        )


def modes(pose: Pose, loop: Asked = None) -> Modes:
    """Vibration modes of a pose, with or without a compensator.

    Assumes distinct poles. Where stiffness and damping act on the base alone, the reduced form of theory §3 is exact
    and is used; where gravity or friction acts on the arm too, the full 2N state space, and the modes are the m of the
    stiffest base springs.
    Warns where a mode is overdamped. Raises InputError if M - E is not positive definite.
    """
    check_pose(pose)
    with collected() as said:
        asked = loop_on(pose.arm, loop)
        E = asked.gain
        check_definite_inertia(pose, E)
        found, rigid_mode, caveat = (_reduced if is_reducible(pose) else _full)(pose, E)
        overdamped = [mode.label for mode in found if mode.damping_ratio >= 1.0]
        if overdamped:
            caution(f"{pose.plant.name}: overdamped base, real poles at {', '.join(overdamped)}.")
    verdict = all(_is_positive(mode) for mode in found)
    if caveat in (PROPORTIONAL, INDICATOR) and _shares_one_beta(reduced_arrays(pose, E)):
        verdict, caveat = True, ONE_BETA
    return Modes(pose, tuple(found), rigid_mode, verdict, caveat, asked.E is not None, tuple(said))


def _reduced(pose: Pose, E: Array) -> tuple[list[Mode], Array, str]:
    reduced, m = reduced_arrays(pose, E), pose.arm.m
    D, K = pose.Dp, pose.Kp
    if m == 0:
        return [], reduced.R0, RIGID
    real = real_shapes(reduced.S, D, K)
    if real is not None:
        caveat = ONE_JOINT if m == 1 else PROPORTIONAL if D.any() else UNDAMPED
        return [_real_mode(pose, reduced, real, i) for i in range(m)], reduced.R0, caveat
    poles = damped_poles(reduced.S, D, K)
    found = [
        _damped_mode(pose, pole, -reduced.U @ pole.shape, reduced.V @ pole.shape, _follow(pose, reduced, pole.shape))
        for pole in poles
    ]
    return found, reduced.R0, INDICATOR


def _full(pose: Pose, E: Array) -> tuple[list[Mode], Array, str]:
    """Full state space: damping and stiffness no longer act on the base alone."""
    system, m = linearise(pose, Gain(E)), pose.arm.m
    if m == 0:
        return [], reduced_arrays(pose, E).R0, RIGID
    poles = damped_poles(system.M, system.D, system.K)
    poles.sort(key=lambda pole: -_base_stiffness_of(pole, system.M, pose.arm))
    base_poles = sorted(poles[:m], key=lambda pole: abs(pole.value))
    found = [_damped_mode(pose, p, system.C @ p.shape, system.B.T @ p.shape, p.shape) for p in base_poles]
    leading = system.C @ np.linalg.solve(
        system.M, system.B
    )  # of P(s) s^2 as s grows: rigid and vibration modes together
    vibration = sum((mode.residue - 2.0 * mode.damping_ratio * mode.frequency * mode.residue_s for mode in found), 0.0)
    return found, leading - vibration, COUPLED


def _real_mode(pose: Pose, reduced: ReducedArrays, real: RealShapes, index: int) -> Mode:
    phi, frequency = real.shapes[:, index], float(np.sqrt(real.stiffness[index]))
    mode = RealMode(
        tuple((-reduced.U @ phi).tolist()),
        tuple((reduced.V @ phi).tolist()),
        frequency,
        float(real.damping[index]) / (2.0 * frequency),
    )
    seen, driven, moved = (float(np.linalg.norm(v)) for v in (mode.a, mode.b, np.subtract(mode.b, mode.a)))
    vanishes = min(seen, driven) <= VANISHING * (driven + moved)  # a = V phi - Jp phi up to sign: rounding of the two
    participation = _participation(pose, phi)
    return Mode(
        frequency=frequency,
        damping_ratio=mode.damping_ratio,
        residue=np.outer(mode.a, mode.b),
        residue_s=np.zeros((pose.arm.k, pose.arm.k)),
        robustness=0.0 if vanishes else float(robustness(mode.a, mode.b)),
        alignment=None if vanishes else float(alignment(mode.a, mode.b)),
        shape=_scaled(_follow(pose, reduced, phi)),
        participation=participation,
        label=_label(pose, participation),
    )


def _damped_mode(pose: Pose, pole: Pole, out: np.ndarray, into: np.ndarray, shape: np.ndarray) -> Mode:
    """(out into^T)/(s - l) and its conjugate, joined; a real pole stands alone and gets zeta = 1."""
    dyad = np.outer(out, into)
    pair = 2.0 if pole.value.imag > 0.0 else 1.0
    residue = -pair * np.real(np.conj(pole.value) * dyad)
    singular_values = np.linalg.svd(residue, compute_uv=False).sum()
    participation = _participation(pose, pose.arm.parts.base(shape))
    return Mode(
        frequency=abs(pole.value),
        damping_ratio=-pole.value.real / abs(pole.value),
        residue=residue,
        residue_s=pair * np.real(dyad),
        robustness=float(np.linalg.eigvalsh(residue + residue.T)[0]),
        alignment=float(np.trace(residue) / singular_values) if singular_values > 0.0 else None,
        shape=_scaled(shape),
        participation=participation,
        label=_label(pose, participation),
    )


def _follow(pose: Pose, reduced: ReducedArrays, base_shape: np.ndarray) -> np.ndarray:
    """All joints of a mode: the arm moves by -W psi when the base moves by psi."""
    return pose.arm.parts.whole(base_shape, -reduced.W @ base_shape)


def _scaled(shape: np.ndarray) -> np.ndarray:
    return np.asarray(shape / shape[np.argmax(np.abs(shape))])


def _participation(pose: Pose, base_shape: np.ndarray) -> Array:
    energy = np.real(np.conj(base_shape) * (pose.arm.base.stiffness @ base_shape))
    return np.asarray(energy / energy.sum())


def _label(pose: Pose, participation: Array) -> str:
    """Base joints by their share of the strain energy, until nine tenths are named."""
    names, named, label = pose.arm.parts.base(pose.arm.mechanism.joint_names), 0.0, []
    for joint in np.argsort(-participation):
        label.append(f"{names[joint]} {100.0 * participation[joint]:.0f} %")
        named += participation[joint]
        if named >= 0.9:
            break
    return ", ".join(label)


def _base_stiffness_of(pole: Pole, M: Array, arm: MountedArm) -> float:
    """Rayleigh quotient of the base springs alone: large for the modes that the base makes."""
    base = arm.parts.base(pole.shape)
    strain = np.real(np.conj(base) @ arm.base.stiffness @ base)
    return float(strain / np.real(np.conj(pole.shape) @ M @ pole.shape))


def _shares_one_beta(reduced: ReducedArrays) -> bool:
    """V = beta Jp with beta <= 0 or beta >= 1, which makes the plant positive real at any damping.  [theory §7]"""
    Jp = reduced.U + reduced.V
    size = float(np.sum(Jp * Jp))
    if size == 0.0:
        return False
    beta = float(np.sum(reduced.V * Jp)) / size
    apart = float(np.linalg.norm(reduced.V - beta * Jp))
    return apart <= POSITIVE_REAL * float(np.linalg.norm(Jp)) and not 0.0 < beta < 1.0


def _is_positive(mode: Mode) -> bool:
    """R = R^T >= 0 up to a relative shortage of POSITIVE_REAL; a mode that the tip cannot see or drive is positive."""
    return mode.alignment is None or 0.5 * (1.0 - mode.alignment) <= POSITIVE_REAL
