"""How sure is a design when the plant is not known exactly? Draws of its parameters, in every cell the same."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace

import numpy as np

from flexbase.cautions import collected
from flexbase.checks import check_left_out
from flexbase.errors import InputError
from flexbase.measures import MEASURES, Measure
from flexbase.model.digest import model_digest
from flexbase.model.loop import Asked, loop_on
from flexbase.model.mounted import MountedArm
from flexbase.plant import Plant, Pose, check_plant
from flexbase.requests import Progress, no_progress
from flexbase.study.montecarlo.collect import to_dataset
from flexbase.study.montecarlo.criterion import USUAL, Criterion, read_criterion
from flexbase.study.montecarlo.distribution import written
from flexbase.study.montecarlo.draws import Draws
from flexbase.study.montecarlo.interval import CONFIDENCE
from flexbase.study.montecarlo.result import MonteCarlo
from flexbase.study.montecarlo.trial import LEAST_BLOCK, TOGETHER, Trial
from flexbase.sweeps.caveats import check_measures
from flexbase.sweeps.cells.axis import block_shape
from flexbase.sweeps.cells.domain import Grid
from flexbase.sweeps.cells.grids import Place, place_of
from flexbase.sweeps.cells.parameters import parameters_of
from flexbase.sweeps.engine.evaluate import chosen_engine
from flexbase.sweeps.engine.formula import Formula
from flexbase.sweeps.engine.runner import run
from flexbase.sweeps.requests import SAMPLES, Cells, Execution

LARGEST = 4_000_000  # cells
USUAL_SHAPE = (100, 100)
OF_A_MAP = "belongs to a map, but a pose is given. Leave it out, or give the plant."


def montecarlo(
    where: Plant | Pose,
    vary: Draws | Mapping[str, object],
    *,
    loop: Asked = None,
    redesign: bool = False,
    criteria: Sequence[Criterion | str] = USUAL,
    cells: Cells = Cells(),
    execution: Execution = Execution(),
    progress: Progress = no_progress,
) -> MonteCarlo:
    """Probability that a design holds while the plant's parameters vary: at a pose, or in all cells of a plant's map.

    The gain stays what it is; only the plant varies. All cells share the draws, so that their differences are no noise.
    Modes are those of `real_modes`; gravity's sag and stiffness and joint friction are left out, as in `sweep`.

    vary : distributions by the names of parameters, drawn 1000 times; or `Draws`, which say how often and how
    loop : a compensator, whose E is the same in every cell; without one the bare plant is judged
    redesign : instead, in each cell the exact design for the plant as it is (one base joint, k = n)
    criteria : all must hold. "definite" (M - E > 0), "robust" (every mode's shortage at most 0.01; "robust=0.05" for
        another), "stable" (`closed_loop_abscissa` < 0; slow), "loop" (`algebraic_loop_radius` < 1), or bounds on any
        measure: "frequency=300:400"
    cells : of a map, as for `sweep`, over tip or joints; 100 x 100 if no shape is given
    progress : called with "evaluations", those done and all of them
    Raises InputError, MissingExtra.
    """
    plant = where.plant if isinstance(where, Pose) else where
    check_plant(plant)
    known = parameters_of(plant.arm)
    how = Draws.checked(vary if isinstance(vary, Draws) else Draws(vary))
    execution = Execution.checked(execution)
    check_left_out(execution, ("store", "resume"), "a Monte Carlo study is kept in memory; save its answer instead.")
    distributions = how.distributions(known)
    asked = _distinct([read_criterion(one) for one in ([criteria] if isinstance(criteria, str) else criteria)])
    measures = _measures(asked)
    E = loop_on(plant.arm, loop).E
    if redesign and E is not None:
        raise InputError("redesign: a compensator is given too. Give one of them.")
    with collected() as said:
        if redesign:
            check_measures(plant, [MEASURES["exact_gain"]], "montecarlo")
        check_measures(plant, measures, "montecarlo")
        arm, place = _place(where, cells)
        formula = Formula(
            arm, measures, place.varied, place.held, tuple(distributions), E, place.planar, place.side, redesign
        )
        shape = place.domain.shape
        total = int(np.prod(shape, dtype=np.int64))
        if total > LARGEST:
            raise InputError(f"shape: {total} cells, up to {LARGEST} are judged. Give fewer.")
        engine = chosen_engine(execution.engine, formula, total * how.samples)
    nominal = np.array([known[name].nominal for name in distributions])
    trial = Trial(formula, engine, asked, how.drawn(known), nominal)
    attributes = {
        "robot": plant.name,
        "model": model_digest(arm),
        "design": "with compensator" if E is not None else "exact design of each pose" if redesign else "bare plant",
        "vary": "; ".join(f"{name} {written(one)}" for name, one in distributions.items()),
        "criteria": "; ".join(map(str, asked)),
        "sampling": how.sampling,
        "seed": how.seed,
        "over": "pose" if isinstance(where, Pose) else cells.over,
        "confidence": CONFIDENCE,
        "engine": engine,
        "cautions": "\n".join(said),
        **(dict(where.where.rows) if isinstance(where, Pose) else {}),
    }
    each = how.samples
    counted = run(
        trial,
        place.domain,
        block_shape(shape, max(LEAST_BLOCK, TOGETHER // each)),
        execution,
        lambda _, done, total: progress("evaluations", done * each, total * each),
        {},
    )
    return MonteCarlo(to_dataset(trial, counted, {name: known[name].unit for name in distributions}, attributes))


def _place(where: Plant | Pose, cells: Cells) -> tuple[MountedArm, Place]:
    """The arm, with a pose's own equilibrium, and its cells; a pose is a grid without axes."""
    cells = Cells.checked(cells)
    if isinstance(where, Pose):
        check_left_out(cells, [one.name for one in fields(cells)], OF_A_MAP)
        arm = replace(where.arm, base=replace(where.arm.base, equilibrium=where.equilibrium))
        return arm, Place(Grid(()), (), tuple(where.joints.tolist()))
    check_left_out(cells, ("vary",), "what varies is drawn. Leave it out of the cells.")
    if cells.over == SAMPLES:
        raise InputError(f'over: "{cells.over}" has no cells to share the draws. Give "tip" or "joints".')
    return where.arm, place_of(where, cells.shaped(USUAL_SHAPE))


def _distinct(criteria: Sequence[Criterion]) -> tuple[Criterion, ...]:
    names = [one.name for one in criteria]
    if not names:
        raise InputError("criteria: none is given, so everything holds. Give such as definite or robust.")
    for name in names:
        if names.count(name) > 1:
            raise InputError(f'criteria: "{name}" is given twice. Give it once.')
    return tuple(criteria)


def _measures(criteria: Sequence[Criterion]) -> tuple[Measure, ...]:
    """What the criteria read; those that may have no value come last, since the others are then not asked either."""
    names = dict.fromkeys(one.measure for one in criteria if one.measure is not None)
    return tuple(sorted((MEASURES[name] for name in names), key=lambda one: one.feasible is not None))
