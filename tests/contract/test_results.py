"""Every result tells itself once: a sheet, which is the same in every medium, and plain numbers."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

import flexbase as fb
from contract.results import DATASETS, EXAMPLES, example
from flexbase.sheets.html import html
from flexbase.sheets.plain import plain
from flexbase.sheets.sheet import Facts
from flexbase.sheets.told import Told
from sheets.reading import Page, on_terminal, signs, words_of

if TYPE_CHECKING:
    import xarray


@pytest.fixture(scope="module", params=EXAMPLES, ids=str)
def result(request: pytest.FixtureRequest) -> Told:
    return example(request.param)


def test_every_result_class_has_an_example():
    """Those of the public face too: `fb` has imported them."""
    told = {one for one in Told.__subclasses__() if one.__module__.startswith(fb.__name__)}
    assert {type(example(name)) for name in EXAMPLES} == told


@pytest.fixture(scope="module", params=[*EXAMPLES, *DATASETS], ids=str)
def answer(request: pytest.FixtureRequest) -> Told | xarray.Dataset:
    return example(request.param)


def test_a_sheet_has_a_heading_and_something_to_say(answer):
    sheet = fb.sheet(answer)
    assert sheet.title.strip()
    assert sheet.parts
    for part in sheet.parts:
        if isinstance(part, Facts):  # each once
            assert len({row.name for row in part.rows}) == len(part.rows)
    assert fb.summary(answer).startswith(sheet.title)


def test_text_notebook_and_terminal_say_the_same(answer, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    sheet = fb.sheet(answer)
    assert signs(fb.summary(answer)) == signs(words_of(sheet)) == signs(Page(html(sheet)).words)
    shown = on_terminal(sheet, capsys)
    assert signs(shown) == signs(words_of(sheet, cautions=False))
    assert max(map(len, shown.split("\n"))) <= 80


def test_results_give_their_sheet_to_notebooks(result):
    assert result._repr_html_() == html(fb.sheet(result))
    assert result.summary() == fb.summary(result)


def test_a_dataset_of_a_study_is_told_as_the_study():
    study = example("Monte Carlo map")
    assert fb.sheet(study.dataset) == study.sheet()
    for no_result in (3, "text", study.dataset["probability"]):
        with pytest.raises(fb.InputError, match="no result of flexbase"):
            fb.sheet(no_result)


def test_plain_numbers_are_strict_json(result):
    found = result.to_dict()
    assert found
    assert json.loads(json.dumps(found, allow_nan=False)) == found == plain(found)
