"""Grids as a user asks for them: checked, named, with windows where none are given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from flexbase.checks import check_length
from flexbase.dynamics.inverse.arm_angles import arm_angles_of_many
from flexbase.dynamics.inverse.branches import elbow_of
from flexbase.dynamics.inverse.two_joint_arm import TwoJointArm, two_joint_arm
from flexbase.errors import InputError, nearest_name
from flexbase.model.task import check_branch
from flexbase.plant import Plant
from flexbase.sweeps.cells.axis import Axis
from flexbase.sweeps.cells.domain import Domain, Grid, Samples, as_they_are
from flexbase.sweeps.cells.parameters import Parameter, parameters_of
from flexbase.sweeps.requests import JOINTS, SAMPLES, TIP, Cells, Range

BENT = 0.5  # rad or m, where joints outside a joint map stand: at zero many arms are stretched
MARGIN = 1.02  # half-width of the default window, over the arm's reach
FARTHEST = 1e5  # rad or m: beyond it sines lose digits
COUNT, FINE = 50, 400  # default cells along an axis: of several, of two


class Place(NamedTuple):
    """A domain, and how a question reads its coordinates: the fields of `Question` of the same names."""

    domain: Domain
    varied: tuple[int, ...]
    held: tuple[float, ...]
    planar: TwoJointArm | None = None
    side: float = 1.0


def place_of(plant: Plant, cells: Cells) -> Place:
    """The cells of a plant, as a question reads them. Raises InputError."""
    return {TIP: tip_place, JOINTS: joint_place, SAMPLES: sample_place}[cells.over](plant, cells)


def tip_place(plant: Plant, cells: Cells, *, targets: bool = False) -> Place:
    """A grid over task rows, the first two if none are named; `hold` gives the others. Raises InputError.

    targets : inputs are the tip's targets, of all k task rows, instead of joints
    """
    arm, task = plant.arm, plant.arm.task
    chosen = tuple(cells.axes) or task.rows[:2]
    if len(chosen) < 2 and not cells.axes:
        raise InputError(
            f"map over tip: {plant.name} has one task row, two are needed; a map over joints needs two arm joints."
        )
    varied = _places("task row", chosen, task.rows)
    others = [i for i in range(task.k) if i not in varied]
    rest = check_length(
        "hold",
        cells.hold,
        len(others),
        f"give hold, one for each task row that does not vary ({' '.join(task.rows[i] for i in others) or 'none'})",
    )
    whole = np.zeros(task.k)
    whole[others] = rest
    held = tuple(whole.tolist())
    planar = two_joint_arm(arm.mechanism, task, arm.base.equilibrium)
    window = _checked_bounds(cells.bounds, len(varied)) or _window(plant, planar, varied, task.units)
    names, units = [task.rows[i] for i in varied], [task.units[i] for i in varied]
    parameters, axes = _axes(names, units, window, plant, cells)
    branch = check_branch(cells.branch or task.branch)
    if targets:
        return Place(Grid(axes, parameters, as_they_are, held, varied), varied, held)
    if planar is not None:
        return Place(Grid(axes, parameters), varied, held, planar, -1.0 if branch == "-" else 1.0)
    solve = partial(arm_angles_of_many, arm.mechanism, task, arm.base.equilibrium, branch=branch)
    return Place(Grid(axes, parameters, solve, held, varied), tuple(range(arm.n)), (0.0,) * arm.n)


def joint_place(plant: Plant, cells: Cells) -> Place:
    """A grid over arm joints, the elbow and the one before if none are named; the others stand at `hold`, n values."""
    names, units, varied, held, window = joint_box(plant, cells.bounds, cells.axes, cells.hold)
    parameters, axes = _axes(names, units, window, plant, cells)
    return Place(Grid(axes, parameters), varied, held)


def sample_place(plant: Plant, cells: Cells) -> Place:
    """Samples of a box of arm joints, all of them if none are named, and of the parameters' ranges."""
    everything = tuple(cells.axes) or plant.arm.joint_names
    names, units, varied, held, window = joint_box(plant, cells.bounds, everything, cells.hold)
    if cells.shape is not None and len(cells.shape) != 1:
        raise InputError(f"shape: {tuple(cells.shape)} given, but samples have one count. Give a single number.")
    vary = cells.vary or {}
    known = _known_parameters(plant, vary)
    low = [*window[0::2], *(vary[name][0] for name in vary)]
    high = [*window[1::2], *(vary[name][1] for name in vary)]
    domain = Samples(
        10_000 if cells.shape is None else _counts(cells.shape, 1)[0],
        (*names, *vary),
        (*units, *(known[name].unit for name in vary)),
        np.array(low),
        np.array(high),
        cells.sampling,
        cells.seed,
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
    window = _checked_bounds(bounds, len(varied)) or whole
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
    plant: Plant,
    cells: Cells,
) -> tuple[int, tuple[Axis, ...]]:
    """How many axes are parameters, and all axes, slowest first."""
    vary, counts = cells.vary or {}, _counts(cells.shape, len(names))
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
    counts = tuple(map(int, shape))
    if len(counts) != axes or min(counts) < 1:
        raise InputError(f"shape: {shape} is not {axes} counts from 1 up, one for each axis.")
    return counts


def _checked_bounds(bounds: Sequence[float] | None, axes: int) -> list[float]:
    """Low, high of each axis; empty where none are given."""
    if bounds is None:
        return []
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
