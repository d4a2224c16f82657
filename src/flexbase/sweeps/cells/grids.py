"""Grids as a user asks for them: checked, named, with windows where none are given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from flexbase.checks import Array, check_length
from flexbase.dynamics.inverse.arm_angles import arm_angles_of_many
from flexbase.dynamics.inverse.branches import elbow_of
from flexbase.dynamics.inverse.two_joint_arm import TwoJointArm, two_joint_arm
from flexbase.errors import InputError, nearest_name
from flexbase.model.task import check_branch
from flexbase.plant import Plant
from flexbase.sweeps.cells.axis import Axis
from flexbase.sweeps.cells.domain import Domain, Grid, Samples
from flexbase.sweeps.cells.parameters import Parameter, parameters_of

BENT = 0.5  # rad or m, where joints outside a joint map stand: at zero many arms are stretched
MARGIN = 1.02  # half-width of the default window, over the arm's reach
FARTHEST = 1e5  # rad or m: beyond it sines lose digits
COUNT, FINE = 50, 400  # default cells along an axis: of several, of two
Range = tuple[float, float, int]


class Place(NamedTuple):
    """A domain, and how a question reads its coordinates: the fields of `Question` of the same names."""

    domain: Domain
    varied: tuple[int, ...]
    held: tuple[float, ...]
    planar: TwoJointArm | None = None
    side: float = 1.0


def tip_place(
    plant: Plant,
    shape: Sequence[int] | None,
    bounds: Sequence[float] | None,
    rows: Sequence[str],
    hold: Sequence[float],
    branch: str | None,
    vary: Mapping[str, Range],
) -> Place:
    """A grid over task rows, the first two if none are named; `hold` gives the others. Raises InputError."""
    arm, task = plant.arm, plant.arm.task
    chosen = tuple(rows) or task.rows[:2]
    if len(chosen) < 2 and not rows:
        raise InputError(
            f"map over tip: {plant.name} has one task row, two are needed; a map over joints needs two arm joints."
        )
    varied = _places("task row", chosen, task.rows)
    others = [i for i in range(task.k) if i not in varied]
    rest = check_length(
        "hold",
        hold,
        len(others),
        f"give hold, one for each task row that does not vary ({' '.join(task.rows[i] for i in others) or 'none'})",
    )
    held = np.zeros(task.k)
    held[others] = rest
    planar = two_joint_arm(arm.mechanism, task, arm.base.equilibrium)
    window = _window(plant, planar, varied, task.units) if bounds is None else _checked_bounds(bounds, len(varied))
    names, units = [task.rows[i] for i in varied], [task.units[i] for i in varied]
    parameters, axes = _axes(names, units, window, _counts(shape, len(varied)), plant, vary)
    branch = check_branch(branch or task.branch)
    if planar is not None:
        side = -1.0 if branch == "-" else 1.0
        return Place(Grid(axes, parameters), varied, tuple(held.tolist()), planar, side)

    def solve(targets: Array) -> tuple[Array, np.ndarray]:
        return arm_angles_of_many(arm.mechanism, task, arm.base.equilibrium, targets, branch)

    grid = Grid(axes, parameters, solve, tuple(held.tolist()), varied)
    return Place(grid, tuple(range(arm.n)), (0.0,) * arm.n)


def joint_place(
    plant: Plant,
    shape: Sequence[int] | None,
    bounds: Sequence[float] | None,
    joints: Sequence[str],
    hold: Sequence[float],
    vary: Mapping[str, Range],
) -> Place:
    """A grid over arm joints, the elbow and the one before if none are named; the others stand at `hold`, n values."""
    names, units, varied, held, window = joint_box(plant, bounds, joints, hold)
    parameters, axes = _axes(names, units, window, _counts(shape, len(varied)), plant, vary)
    return Place(Grid(axes, parameters), varied, held)


def sample_place(
    plant: Plant,
    shape: Sequence[int] | None,
    bounds: Sequence[float] | None,
    joints: Sequence[str],
    hold: Sequence[float],
    vary: Mapping[str, Range],
    sampling: str,
    seed: int,
) -> Place:
    """Samples of a box of arm joints, all of them if none are named, and of the parameters' ranges."""
    everything = tuple(joints) or plant.arm.joint_names
    names, units, varied, held, window = joint_box(plant, bounds, everything, hold)
    if shape is not None and len(shape) != 1:
        raise InputError(f"shape: {tuple(shape)} given, but samples have one count. Give a single number.")
    known = _known_parameters(plant, vary)
    low = [*window[0::2], *(vary[name][0] for name in vary)]
    high = [*window[1::2], *(vary[name][1] for name in vary)]
    domain = Samples(
        _counts(shape, 1)[0] if shape else 10_000,
        (*names, *vary),
        (*units, *(known[name].unit for name in vary)),
        np.array(low),
        np.array(high),
        sampling,
        seed,
    )
    return Place(domain, varied, held)


def joint_box(
    plant: Plant, bounds: Sequence[float] | None, joints: Sequence[str], hold: Sequence[float]
) -> tuple[list[str], list[str], tuple[int, ...], tuple[float, ...], list[float]]:
    """Names, units and places of the joints that vary, all n held values, and low, high of each; checked."""
    arm = plant.arm
    names, ranges = arm.joint_names, arm.parts.arm(arm.mechanism.ranges)
    if arm.n < 2 and not joints:
        raise InputError(f"map over joints: {plant.name} has one arm joint, two are needed.")
    elbow = elbow_of(arm.n) or 1
    chosen = tuple(joints) or names[elbow - 1 : elbow + 1]
    varied = _places("arm joint", chosen, names)
    whole = [edge for place in varied for edge in ranges[place]]
    window = whole if bounds is None else _checked_bounds(bounds, len(varied))
    held = check_length("hold", hold, arm.n, "one for each arm joint") if len(hold) else np.full(arm.n, BENT)
    return list(chosen), [arm.joint_units[place] for place in varied], varied, tuple(held.tolist()), window


def _places(what: str, chosen: Sequence[str], names: Sequence[str]) -> tuple[int, ...]:
    for name in chosen:
        if name not in names:
            raise InputError(f'axes: no {what} "{name}". {nearest_name(name, names)}')
    if len(set(chosen)) != len(chosen):
        raise InputError(f"axes: {list(chosen)} names a {what} twice. Give each one once.")
    return tuple(names.index(name) for name in chosen)


def _axes(
    names: Sequence[str],
    units: Sequence[str],
    window: Sequence[float],
    counts: Sequence[int],
    plant: Plant,
    vary: Mapping[str, Range],
) -> tuple[int, tuple[Axis, ...]]:
    """How many axes are parameters, and all axes, slowest first."""
    known = _known_parameters(plant, vary)
    outer = [Axis(name, known[name].unit, np.linspace(*vary[name])) for name in vary]
    inner = [
        Axis(name, units[i], np.linspace(window[2 * i], window[2 * i + 1], counts[i])) for i, name in enumerate(names)
    ]
    return len(outer), (*outer, *reversed(inner))


def _known_parameters(plant: Plant, vary: Mapping[str, Range]) -> dict[str, Parameter]:
    """The plant's parameters by name, once the ranges of those that vary are checked."""
    known = parameters_of(plant.arm)
    for name, given in vary.items():
        if name not in known:
            raise InputError(f'vary: no parameter "{name}". {nearest_name(name, known)}')
        low, high, count = given
        least = known[name].least
        if not (least <= low <= high <= FARTHEST and count >= 1):
            raise InputError(
                f"vary: {name} from {low:g} to {high:g} in {count} values; values from {least:g} to {FARTHEST:g} are "
                "needed, low before high, and at least one of them."
            )
    return known


def _counts(shape: Sequence[int] | None, axes: int) -> tuple[int, ...]:
    if shape is None:
        return (FINE,) * axes if axes <= 2 else (COUNT,) * axes
    counts = tuple(int(count) for count in shape) if isinstance(shape, Sequence) else ()
    if len(counts) != axes or min(counts) < 1:
        raise InputError(f"shape: {shape} is not {axes} counts from 1 up, one for each axis.")
    return counts


def _checked_bounds(bounds: Sequence[float], axes: int) -> list[float]:
    window = check_length("bounds", bounds, 2 * axes, "low, high of each axis in turn").tolist()
    if not all(low < high for low, high in zip(window[0::2], window[1::2], strict=True)):
        raise InputError(f"bounds: {window} are not low, high, low, high. Give each low below its high.")
    if max(map(abs, window)) > FARTHEST:
        raise InputError(f"bounds: {window} leave -{FARTHEST:g} to {FARTHEST:g} rad or m. Give nearer ones.")
    return list(window)


def _window(plant: Plant, planar: TwoJointArm | None, varied: Sequence[int], units: Sequence[str]) -> list[float]:
    """A square around all that the tip can reach; a full turn for rotations."""
    radius = MARGIN * (plant.arm.mechanism.reach if planar is None else planar.upper + planar.fore)
    window: list[float] = []
    for i in varied:
        centre = 0.0 if planar is None else float(planar.shoulder[i])
        window += [-np.pi, np.pi] if units[i] == "rad" else [centre - radius, centre + radius]
    return window
