"""Numbers for people and for programs."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
import pytest

from flexbase.sheets import units
from flexbase.sheets.numbers import kilo, listed, matrix, number
from flexbase.sheets.plain import Plain, plain


class Pair(NamedTuple):
    low: float
    high: float


@dataclass
class Inner:
    value: float
    rows: np.ndarray

    @property
    def doubled(self) -> float:
        return 2.0 * self.value

    def entries(self) -> dict[str, float]:
        return {"value_m": self.value, "doubled_m": self.doubled}


@dataclass
class Whole(Plain):
    inner: Inner | None
    name: str = "arm"

    document: ClassVar = ("title=name", "inner", "doubled=inner.doubled", "*inner.entries")


@dataclass
class Field(Plain):
    gap: float
    pair: Pair


def test_a_document_takes_fields_paths_and_entries():
    found = Whole(Inner(1.5, np.array([[1.0, np.nan]]))).to_dict()
    assert found == {
        "title": "arm",
        "inner": {"value": 1.5, "rows": [[1.0, None]]},
        "doubled": 3.0,
        "value_m": 1.5,
        "doubled_m": 3.0,
    }
    assert list(found) == ["title", "inner", "doubled", "value_m", "doubled_m"]


def test_without_a_document_all_fields():
    assert Field(-np.inf, Pair(0.0, np.nan)).to_dict() == {"gap": None, "pair": {"low": 0.0, "high": None}}


@pytest.mark.parametrize(
    ("value", "wanted"),
    [
        (np.float64(2.5), 2.5),
        (np.float32("nan"), None),
        (np.int8(3), 3),
        (np.bool_(True), True),
        (np.array([1, 2]), [1, 2]),
        (np.array(["a", "b"]), ["a", "b"]),
        (np.array([True]), [True]),
        (np.array([1.0, np.inf]), [1.0, None]),
        (np.array([]), []),
        (((1.0, None), [np.nan]), [[1.0, None], [None]]),
        ({1: {"x": np.inf}}, {"1": {"x": None}}),
        ("<script>", "<script>"),
    ],
)
def test_plain_values_are_strict_json(value, wanted):
    assert plain(value) == wanted
    assert json.loads(json.dumps(plain(value), allow_nan=False)) == wanted


def test_numbers_as_people_read_them():
    assert [number(None), number(-0.0), number(1 / 3, 3)] == ["undefined", "0", "0.333"]
    assert [kilo(240.0), kilo(8600.0), kilo(105000.0)] == ["0.24", "8.6", "105"]
    assert listed([0.5, 1.0], ["q1", "q2"], ["rad", "m"]) == "q1 0.5 rad, q2 1 m"
    assert listed([0.5, 1.0], units=["rad", "m"]) == "0.5 rad, 1 m"
    assert matrix(np.array([[1.0, -20.0], [0.5, 3.0]])) == "  1  -20\n0.5    3"
    assert matrix(np.array([1.0, 2.0])) == "1  2"
    assert matrix(np.full((1, 5), 1 / 3)) == "  ".join(["0.333"] * 5)
    assert matrix(np.zeros((0, 0))) == ""


def test_units_follow_the_coordinates():
    assert units.each("stiffness", ["m", "rad"]) == ["N/m", "N m/rad"]
    assert units.common("effort", ["rad", "rad"]) == "N m"
    assert units.common("effort", ["rad", "m"]) == "N and N m"
