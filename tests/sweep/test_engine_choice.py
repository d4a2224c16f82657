"""Which engine answers: the one asked for, or by the number of evaluations."""

from __future__ import annotations

import pytest

import flexbase as fb
from flexbase.measures import MEASURES
from flexbase.sweeps.engine import evaluate
from flexbase.sweeps.engine.evaluate import AUTO, COMPILED, ROWS, chosen_engine, engine_of
from flexbase.sweeps.engine.formula import Formula


@pytest.fixture
def formula(paper: fb.Plant) -> Formula:
    return Formula(paper.arm, (MEASURES["robustness"],), (0, 1), (0.0, 0.0))


@pytest.mark.parametrize(
    ("wanted", "evaluations", "engine"),
    [
        (ROWS, 10**9, ROWS),
        (AUTO, 1, ROWS),
        (AUTO, 199_999, ROWS),
        (AUTO, 200_000, COMPILED),
        (COMPILED, 1, COMPILED),
    ],
)
def test_the_number_of_evaluations_decides(formula: Formula, wanted: str, evaluations: int, engine: str) -> None:
    assert chosen_engine(wanted, formula, evaluations) == engine


def test_a_wrong_engine_is_named(formula: Formula) -> None:
    with pytest.raises(fb.InputError, match='engine: "fast" is unknown'):
        chosen_engine("fast", formula, 1)


def test_a_kernel_is_made_once_a_process(formula: Formula, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evaluate, "_READY", {})
    rows, kernel = engine_of(formula, ROWS), engine_of(formula, COMPILED)
    assert (rows.name, rows.kernel, kernel.name) == (ROWS, None, COMPILED)
    assert kernel.kernel is not None
    assert engine_of(formula, COMPILED) is kernel
