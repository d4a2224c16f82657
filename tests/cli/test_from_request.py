"""Options made of a request: what a command line gives is the request, with its defaults, units and choices."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import pytest
from cyclopts import App, Group

from flexbase import InputError
from flexbase.checks import check_request
from flexbase.cli.options.from_request import from_request
from flexbase.cli.options.values import sign
from flexbase.requests import asked


@dataclass(frozen=True, kw_only=True)
class Trip:
    """Of every kind, one."""

    speed: float = asked(0.5, "of the cart", unit="m/s", written="V")
    stops: int = asked(3, "on the way")
    fuel: str = asked("wood", "what burns", choices=("wood", "coal"))
    loud: bool = asked(False, "whistle")
    weights: tuple[float, ...] | None = asked(None, "of the load", unit="kg", written="W,W")
    cells: tuple[int, ...] = asked((), "of the map")
    towns: tuple[str, ...] = asked((), "to see")
    vary: Mapping[str, tuple[float, float, int]] | None = asked(None, "what else")
    side: str | None = asked(None, "of the road", written="+|-")
    hidden: float = asked(1.0, "not for the command line")
    plain: int = 7  # not asked for at all


@from_request(Group("Trip"), names={"fuel": ("--fuel", "--burn")}, readers={"side": sign}, without=("hidden",))
class TripOptions(Trip):
    """On the command line."""


def read(*words: str) -> Trip:
    app = App(result_action="return_value", help_format="plaintext")
    app.default(command)
    found = app(list(words), exit_on_error=False, print_error=False)
    assert isinstance(found, Trip)
    return found


def command(*, trip: TripOptions = TripOptions()) -> Trip:  # noqa: B008
    return trip


def values(trip: Trip) -> dict[str, object]:
    return {one.name: getattr(trip, one.name) for one in fields(trip)}


def test_nothing_given_is_the_request_itself() -> None:
    assert values(read()) == values(Trip())


def test_every_kind_is_read() -> None:
    found = read(
        *("--speed", "-2e-1", "--stops", "4", "--burn", "coal", "--loud", "--weights", "-1,2.5", "--cells", "3,4"),
        *("--towns", "a,b", "--vary", "x=0:1:5", "--side", "-"),
    )
    wanted = Trip(
        speed=-0.2, stops=4, fuel="coal", loud=True, weights=(-1.0, 2.5), cells=(3, 4), towns=("a", "b"),
        vary={"x": (0.0, 1.0, 5)}, side="-",
    )  # fmt: skip
    assert values(found) == values(wanted)


@pytest.mark.parametrize(
    ("words", "match"),
    [
        (("--speed", "fast"), '--speed: "fast" is not a number'),
        (("--speed", "nan"), "--speed"),
        (("--stops", "1.5"), '--stops: "1.5"'),
        (("--burn", "cole"), '--burn: "cole" is unknown. Did you mean "coal"'),
        (("--side", "up"), '--side: "up"'),
    ],
)
def test_a_wrong_word_names_its_option(words: tuple[str, ...], match: str) -> None:
    with pytest.raises(InputError, match=match):
        read(*words)


@pytest.mark.parametrize("option", ["--hidden", "--plain"])
def test_what_is_left_out_is_no_option(option: str) -> None:
    with pytest.raises(Exception, match=f"(?i)unknown.*{option}"):
        read(option, "2")


def test_help_says_text_unit_default_and_choices(capsys: pytest.CaptureFixture[str]) -> None:
    app = App(result_action="return_value", help_format="plaintext")
    app.default(command)
    app(["--help"], exit_on_error=False)
    shown = " ".join(capsys.readouterr().out.replace("│", " ").split())
    for words in (
        "of the cart [m/s], 0.5",
        "on the way, 3",
        "what burns: wood (if left out) or coal",
        "of the load [kg]",
    ):
        assert words in shown
    assert "--no-loud" not in shown
    assert "not for the command line" not in shown


@pytest.mark.parametrize(
    ("wrong", "match"),
    [
        ({"speed": "fast"}, "speed: 'fast' is not a number"),
        ({"speed": 1j}, "speed"),
        ({"speed": True}, "speed"),
        ({"stops": 1.5}, "stops: 1.5 is not a whole number"),
        ({"fuel": 3}, "fuel: 3 is not a word"),
        ({"fuel": "cole"}, 'fuel: "cole" is unknown. Did you mean "coal"'),
        ({"loud": 1}, "loud: 1 is not True or False"),
        ({"weights": 1.0}, "weights"),
        ({"cells": (1, "2")}, "cells"),
        ({"vary": (("x", (0.0, 1.0)),)}, "vary"),
    ],
)
def test_another_kind_of_value_is_refused_in_python(wrong: dict[str, object], match: str) -> None:
    with pytest.raises(InputError, match=match):
        check_request("trip", Trip(**wrong), Trip)  # type: ignore[arg-type]


def test_something_else_is_no_request() -> None:
    with pytest.raises(InputError, match=r"trip: dict given. Give a Trip, such as Trip\(\)"):
        check_request("trip", {"speed": 1.0}, Trip)
    check_request("trip", Trip(weights=(1, 2.0), side=None), Trip)
    check_request("trip", read("--speed", "2"), Trip)
