"""Exact verdict at a pose: is it positive real, by how much not, and at which frequencies?  [theory §5]"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexbase.cautions import collected
from flexbase.checks import Array, check_definite, check_symmetric, positive_number
from flexbase.errors import InputError
from flexbase.linear.linearise import is_reducible
from flexbase.linear.passivity.level_search import Interval, intervals_below
from flexbase.linear.passivity.negative_imaginary import negative_imaginary
from flexbase.linear.passivity.passivity_index import input_index, largest_gain, output_index, skewness
from flexbase.linear.passivity.popov import Popov
from flexbase.linear.passivity.stable_part import Port, compressed
from flexbase.linear.passivity.verdict import POSITIVE_REAL, Verdict
from flexbase.linear.passivity.vibration import (
    UndampedMode,
    Vibration,
    base_vibration,
    vibration_of,
    vibration_of_system,
)
from flexbase.linear.second_order import SecondOrder
from flexbase.model.loop import Asked, Gain, loop_on
from flexbase.plant import Pose, check_pose

HIDDEN = 1e-6  # of the response near one resonance alone: a shortage that deserves a word


def verdict(model: Pose | SecondOrder, loop: Asked = None, bandwidth: float | None = None) -> Verdict:
    """Whether G(s) = s P(s), tip force to tip velocity, is positive real, over all frequencies at once.  [theory §5]

    Holds at any damping of base and joints, with gravity's stiffness, with rigid motions and with undamped modes:
    no residues, no frequency grid. By crossings of levels, to RESOLUTION of the largest response.

    model : a pose, or a system of your own with M > 0, D >= 0 and symmetric K
    loop : a compensator, or anything with a gain E; only with a pose
    bandwidth : judge frequencies up to this one only [rad/s]
    Raises InputError if M - E is not positive definite, or the system is not of this kind.
    """
    band = (0.0, np.inf if bandwidth is None else positive_number("bandwidth", bandwidth, "rad/s"))
    if isinstance(model, SecondOrder):
        if loop is not None:
            raise InputError("compensator: given with a system. Take E from its M, or give a pose.")
        return _judged(None, vibration_of_system(_checked(model)), band)
    check_pose(model)
    with collected() as said:
        asked = loop_on(model.arm, loop)
    gain = Gain(asked.gain)
    alone = None if is_reducible(model) else _judged(None, base_vibration(model, gain), band)
    found = _judged(model, vibration_of(model, gain), band, alone)
    return replace(found, compensated=asked.E is not None, cautions=tuple(said))


def _judged(pose: Pose | None, vibration: Vibration, band: Interval, alone: Verdict | None = None) -> Verdict:
    whole = vibration.force_to_velocity()
    port = compressed(whole)
    gain = largest_gain(port, band)
    worst = input_index(port, gain.value, band)
    shortage, relative = min(worst.value, 0.0), min(worst.value, 0.0) / gain.value if gain.value > 0.0 else 0.0
    failing, half = _intervals(port, gain.value, shortage, worst.at, band)
    bad = [mode for mode in vibration.undamped if mode.frequency <= band[1] and _misses(mode.residue)]
    rigid_fails = _misses(vibration.rigid)
    other = negative_imaginary(vibration, band)
    unbounded = bool(bad) or rigid_fails or vibration.falling > 0.0
    if unbounded:
        shortage = relative = -np.inf
        at = bad[0].frequency if bad else 0.0
        failing = tuple(sorted([*failing, *((mode.frequency, mode.frequency) for mode in bad)]))
    else:
        at = worst.at
    positive = not unbounded and relative >= -POSITIVE_REAL
    cautions = (*(_hidden(port, gain.at, band) if positive else ()), *_cautions(pose, alone))
    searched = (gain, worst, *(() if other is None else (other,)))
    return Verdict(
        pose=pose,
        positive_real=positive,
        shortage=shortage,
        relative_shortage=relative,
        worst_at=None if positive else at,
        fails_at=failing,
        half_at=half,
        largest_gain=gain.value,
        largest_at=gain.at,
        input_index=-np.inf if unbounded else worst.value,
        output_index=_output_index(vibration, whole, gain.value, positive, unbounded),
        negative_imaginary=positive,
        negative_imaginary_shortage=-np.inf if unbounded else relative if other is None else other.relative,
        skew_low=_skew_at_rest(vibration),
        skew_high=skewness(whole.C @ whole.B),
        rigid_mode=vibration.rigid,
        undamped=tuple(mode.frequency for mode in vibration.undamped),
        bandwidth=None if np.isinf(band[1]) else band[1],
        caveats=(*_caveats(vibration, bad, rigid_fails, all(one.settled for one in searched)), *cautions),
        base_alone=alone,
        port=port,
    )


def _intervals(
    port: Port, gain: float, shortage: float, worst: float, band: Interval
) -> tuple[tuple[Interval, ...], tuple[Interval, ...]]:
    """Where lambda_min is below the tolerance, and where below half of its lowest value."""
    if shortage >= -POSITIVE_REAL * gain:
        return (), ()
    popov, known = Popov(port, gain), np.append(port.seeds(), worst)

    def below(level: float) -> tuple[Interval, ...]:
        return intervals_below(
            port.least_eigenvalue, lambda value: popov(0.0, 1.0, -2.0 * value), level, known, band=band
        )

    return below(-POSITIVE_REAL * gain), below(0.5 * shortage)


def _output_index(vibration: Vibration, whole: Port, gain: float, positive: bool, unbounded: bool) -> float | None:
    if unbounded:
        return -np.inf
    if positive and (vibration.undamped or vibration.rigid.any()):
        return 0.0  # poles on the axis bear no feedback taken off
    if vibration.undamped:
        return None
    return output_index(whole, gain, vibration.rigid) if gain > 0.0 else 0.0


def _misses(residue: Array) -> bool:
    """Whether R = R^T >= 0 fails: the trace then falls short of the sum of singular values."""
    sizes = float(np.linalg.svd(residue, compute_uv=False).sum())
    return sizes > 0.0 and 0.5 * (1.0 - float(np.trace(residue)) / sizes) > POSITIVE_REAL


def _skew_at_rest(vibration: Vibration) -> float | None:
    """Relative skew part of the compliance at rest; None where something has no spring."""
    if np.any(vibration.squares <= 0.0):
        return None
    return skewness((vibration.c / vibration.squares) @ vibration.b)


def _caveats(vibration: Vibration, bad: list[UndampedMode], rigid_fails: bool, settled: bool) -> tuple[str, ...]:
    said = []
    if vibration.falling > 0.0:
        said.append(
            f"Without a loop this pose falls, at a rate of about {vibration.falling:.3g} 1/s: no port of it is passive."
        )
    if rigid_fails:
        said.append("The rigid motion R0 is not symmetric and positive semidefinite.")
    if bad:
        said.append(
            f"Undamped vibration at {bad[0].frequency:.6g} rad/s with a residue that is not positive: the shortage has "
            "no bound. Give the base some damping to rank poses."
        )
    elif vibration.undamped:
        said.append("Undamped vibrations are judged by their residues, which is exact.")
    if not settled:
        said.append("The search for the lowest value did not settle: the shortage may be larger.")
    return tuple(said)


def _cautions(pose: Pose | None, alone: Verdict | None) -> tuple[str, ...]:
    """What a pose's verdict counts and leaves out; beside gravity and friction of the arm, the base by itself."""
    said = []
    if alone is not None:
        answer = "positive real" if alone.positive_real else f"not positive real, shortage {alone.in_words()}"
        said.append(
            f"Gravity stiffness and joint friction are counted; with springs and dampers of the base alone: {answer}."
        )
    if pose is not None and pose.arm.n > pose.arm.k:
        said.append("Redundant arm: this is the port of the task alone; what drives the self-motion is coupled to it.")
    return tuple(said)


def _hidden(port: Port, largest_at: float, band: Interval) -> tuple[str, ...]:
    """A word where a shortage is within the tolerance only because a resonance elsewhere is so high."""
    seeds = port.seeds()
    seeds = seeds[seeds <= band[1]]
    size = port.largest_singular_value(seeds)
    missing = np.where(size > 0.0, -port.least_eigenvalue(seeds) / np.where(size > 0.0, size, 1.0), 0.0)
    if not len(seeds) or float(missing.max()) <= HIDDEN:
        return ()
    return (
        f"Within the tolerance only beside the resonance at {largest_at:.4g} rad/s: near {seeds[missing.argmax()]:.4g} "
        f"rad/s, {100.0 * missing.max():.2g} % of the response there is missing.",
    )


def _checked(system: SecondOrder) -> SecondOrder:
    """Raises InputError where a system's matrices are not those of a mechanism."""
    for name, matrix in (("M", system.M), ("D", system.D), ("K", system.K)):
        check_symmetric(f"system {name}", matrix, "")
    check_definite("system M", system.M, "", allow_zero=False, why="is no inertia")
    check_definite("system D", system.D, "", allow_zero=True, why="feeds energy in")
    if system.B.shape[1] != len(system.C):
        raise InputError(
            f"system: {system.B.shape[1]} inputs and {len(system.C)} outputs. Give a velocity for each force."
        )
    return system
