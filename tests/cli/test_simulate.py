"""`simulate`: the move of Fig. 9."""

from __future__ import annotations

from pathlib import Path

import pytest

from .conftest import TIP, Call

MOVE = ("simulate", "ueda2003", "--from", "0.33,0.25", "--to", TIP)


def test_settles_with_the_compensator(call: Call, compensator_file: Path, tmp_path: Path) -> None:
    picture = tmp_path / "run.png"
    outcome = call(*MOVE, "--compensator", compensator_file, "--interval", "1e-3", "--json", "-o", picture)
    found = outcome.document("simulate")
    assert outcome.status == 0
    assert set(found) >= {"t", "q", "tip_error", "settled", "settling_time_s", "peak_error_m"}
    assert found["settled"] is True
    assert found["settling_time_s"] < 0.1
    assert len(found["t"]) == len(found["q"]) == len(found["tip_error"]) == 401
    assert picture.stat().st_size > 0


def test_does_not_settle_without(call: Call) -> None:
    outcome = call(*MOVE)
    assert outcome.status == 1
    assert outcome.err == ""
    assert "Does not settle" in outcome.out
    assert max(map(len, outcome.out.splitlines())) <= 80


def test_options_reach_the_run(call: Call) -> None:
    """A short move with other times and softer gains: it ends where it was told to."""
    words = ("--switch", "0.05", "--end", "0.07", "--interval", "0.01", "--trajectory", "trapezoidal")
    found = call("simulate", "ueda2003", "--from", "0.33,-0.24", "--to", TIP, *words, "--json").document("simulate")
    assert found["switch_s"] == 0.05
    assert found["t"] == pytest.approx([0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07])


@pytest.mark.parametrize("option", ["--from", "--to"])
def test_unreachable_end_is_named(call: Call, option: str) -> None:
    ends = {"--from": TIP, "--to": TIP} | {option: "9,9"}
    outcome = call("simulate", "ueda2003", *(word for pair in ends.items() for word in pair))
    assert (outcome.status, outcome.out) == (2, "")
    assert outcome.err.startswith(f"error: {option}: [9.0, 9.0] is out of reach")
