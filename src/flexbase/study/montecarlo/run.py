"""How sure is a design when the plant is not known exactly? Draws of its parameters, in every cell the same."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from flexbase.checks import choose
from flexbase.errors import FlexbaseWarning, InputError, MissingExtra, nearest_name
from flexbase.measures import MEASURES, Measure
from flexbase.model.loop import Asked, loop_on
from flexbase.model.mounted import MountedArm
from flexbase.plant import Plant, Pose, check_plant
from flexbase.study.montecarlo.collect import Progress, run_all, to_dataset
from flexbase.study.montecarlo.criterion import USUAL, Criterion, read_criterion
from flexbase.study.montecarlo.distribution import Distribution, read_distribution, written
from flexbase.study.montecarlo.draws import RANDOM, draw
from flexbase.study.montecarlo.interval import CONFIDENCE
from flexbase.study.montecarlo.result import Probability
from flexbase.study.montecarlo.trial import Trial
from flexbase.sweeps.caveats import check_measures
from flexbase.sweeps.cells.domain import Grid
from flexbase.sweeps.cells.grids import Place, joint_place, tip_place
from flexbase.sweeps.cells.parameters import parameters_of
from flexbase.sweeps.engine.evaluate import AUTO, COMPILED, ENGINES, ROWS, Engine, compiled
from flexbase.sweeps.engine.question import Question, model_digest

WORTH_COMPILING = 200_000  # evaluations from which a kernel gains more than the half second that it takes to make
LARGEST = 4_000_000  # cells
USUAL_SHAPE = (100, 100)


def montecarlo(
    where: Plant | Pose,
    vary: Mapping[str, Distribution | str | float],
    *,
    loop: Asked = None,
    redesign: bool = False,
    criteria: Sequence[Criterion | str] = USUAL,
    samples: int = 1000,
    seed: int = 0,
    sampling: str = RANDOM,
    over: str = "tip",
    shape: Sequence[int] | None = None,
    bounds: Sequence[float] | None = None,
    branch: str | None = None,
    axes: Sequence[str] = (),
    hold: Sequence[float] = (),
    engine: str = AUTO,
    progress: Progress = lambda done, total: None,
) -> Probability:
    """Probability that a design holds while the plant's parameters vary: at a pose, or in all cells of a plant's map.

    The gain stays what it is; only the plant varies. All cells share the draws, so that their differences are no noise.
    Modes are those of `real_modes`; gravity's sag and stiffness and joint friction are left out, as in `sweep`.

    vary : a parameter's name -> its distribution, such as `"normal(1,0.15)"`; parameters are independent. Names as for
        `sweep`, those of a single joint included: `stiffness.q1`
    loop : a compensator, whose E is the same in every cell; without one the bare plant is judged
    redesign : instead, in each cell the exact design for the plant as it is (one base joint, k = n)
    criteria : all must hold. "definite" (M - E > 0), "robust" (every mode's shortage at most 0.01; "robust=0.05" for
        another), "stable" (`closed_loop_abscissa` < 0; slow), "loop" (`algebraic_loop_radius` < 1), or bounds on any
        measure: "frequency=300:400"
    samples, seed, sampling : draws; "random" (independent) or "sobol" (more even; intervals are then too wide)
    over, shape, bounds, branch, axes, hold : of a map, as for `sweep`; 100 x 100 cells if left out
    engine : "compiled", "rows" (NumPy), or "auto"
    progress : called with the evaluations done and all of them
    Raises InputError, MissingExtra.
    """
    plant = where.plant if isinstance(where, Pose) else where
    check_plant(plant)
    known = parameters_of(plant.arm)
    if not vary:
        raise InputError(f"vary: nothing varies. Give a parameter's distribution; there are {', '.join(known)}.")
    for name in vary:
        if name not in known:
            raise InputError(f'vary: no parameter "{name}". {nearest_name(name, known)}')
    distributions = {name: read_distribution(name, given, known[name]) for name, given in vary.items()}
    asked = _distinct([read_criterion(one) for one in ([criteria] if isinstance(criteria, str) else criteria)])
    measures = _measures(asked)
    if redesign:
        if loop_on(plant.arm, loop).E is not None:
            raise InputError("redesign: a compensator is given too. Give one of them.")
        check_measures(plant, [MEASURES["exact_gain"]], "montecarlo")
    check_measures(plant, measures, "montecarlo")
    arm, place = _place(where, over, shape, bounds, branch, axes, hold)
    draws = draw(distributions, known, samples, sampling, seed)
    E = loop_on(plant.arm, loop).E
    question = Question(
        arm, measures, place.varied, place.held, tuple(vary), E, place.planar, place.side, redesigned=redesign
    )
    assert isinstance(place.domain, Grid)
    total = int(np.prod(place.domain.shape, dtype=np.int64))
    if total > LARGEST:
        raise InputError(f"shape: {total} cells, up to {LARGEST} are judged. Give fewer.")
    nominal = np.array([known[name].nominal for name in vary])
    trial = Trial(_engine(engine, question, total * samples), place.domain, asked, draws, nominal)
    arrays = run_all(trial, progress)
    attributes = {
        "robot": plant.name,
        "model": model_digest(arm),
        "design": "with compensator" if E is not None else "exact design of each pose" if redesign else "bare plant",
        "vary": "; ".join(f"{name} {written(one)}" for name, one in distributions.items()),
        "criteria": "; ".join(map(str, asked)),
        "sampling": sampling,
        "seed": seed,
        "over": "pose" if isinstance(where, Pose) else over,
        "confidence": CONFIDENCE,
        "engine": trial.engine.name,
    }
    units = {name: known[name].unit for name in vary}
    return Probability(to_dataset(trial, arrays, units, attributes))


def _place(
    where: Plant | Pose,
    over: str,
    shape: Sequence[int] | None,
    bounds: Sequence[float] | None,
    branch: str | None,
    axes: Sequence[str],
    hold: Sequence[float],
) -> tuple[MountedArm, Place]:
    """The arm, with a pose's own equilibrium, and its cells; a pose is a grid without axes."""
    if isinstance(where, Pose):
        given = {
            "over": None if over == "tip" else over,
            "shape": shape,
            "bounds": bounds,
            "branch": branch,
            "axes": tuple(axes),
            "hold": tuple(hold),
        }
        for name, value in given.items():
            if value not in (None, ()):
                raise InputError(f"{name}: belongs to a map, but a pose is given. Leave it out, or give the plant.")
        arm = replace(where.arm, base=replace(where.arm.base, equilibrium=where.equilibrium))
        return arm, Place(Grid(()), (), tuple(where.joints.tolist()))
    if shape is None and len(axes) in (0, 2):
        shape = USUAL_SHAPE
    if over == "tip":
        return where.arm, tip_place(where, shape, bounds, axes, hold, branch, {})
    if over == "joints":
        return where.arm, joint_place(where, shape, bounds, axes, hold, {})
    raise InputError(f'over: "{over}" is unknown. Give "tip" or "joints".')


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


def _engine(wanted: str, question: Question, evaluations: int) -> Engine:
    choose("engine", wanted, dict.fromkeys(ENGINES))
    if wanted == ROWS or (wanted == AUTO and evaluations < WORTH_COMPILING):
        return Engine(question)
    try:
        return compiled(question)
    except MissingExtra as missing:
        if wanted == COMPILED:
            raise
        warnings.warn(f"{missing} Until then it runs on NumPy, ten times slower.", FlexbaseWarning, stacklevel=3)
        return Engine(question)
