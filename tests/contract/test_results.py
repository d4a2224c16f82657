"""Every result tells itself once: a sheet, which is the same in every medium, and plain numbers."""

from __future__ import annotations

import json

import pytest

import flexbase as fb
from contract.results import EXAMPLES, example
from flexbase.sheets.html import html
from flexbase.sheets.plain import plain
from flexbase.sheets.told import Told
from sheets.reading import Page, on_terminal, signs, words_of


@pytest.fixture(scope="module", params=EXAMPLES, ids=str)
def result(request: pytest.FixtureRequest) -> Told:
    return example(request.param)


def test_every_result_class_of_the_public_face_has_an_example():
    told = {one for one in vars(fb).values() if isinstance(one, type) and issubclass(one, Told)}
    assert {type(example(name)) for name in EXAMPLES} == told


def test_a_sheet_has_a_heading_and_something_to_say(result):
    sheet = result.sheet()
    assert sheet.title.strip()
    assert sheet.parts
    assert result.summary().startswith(sheet.title)


def test_text_notebook_and_terminal_say_the_same(result, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    sheet = result.sheet()
    assert signs(result.summary()) == signs(words_of(sheet)) == signs(Page(html(sheet)).words)
    assert result._repr_html_() == html(sheet)
    shown = on_terminal(sheet, capsys)
    assert signs(shown) == signs(words_of(sheet, cautions=False))
    assert max(map(len, shown.split("\n"))) <= 80


def test_plain_numbers_are_strict_json(result):
    found = result.to_dict()
    assert found
    assert json.loads(json.dumps(found, allow_nan=False)) == found == plain(found)
