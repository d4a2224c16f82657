"""`design`, its file, and the commands that take the file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import flexbase as fb

from .conftest import TIP, Call

AT = ("design", "ueda2003", "--tip", TIP)
CERTIFICATE = {
    "min_eig_modified_inertia",
    "robustness_before",
    "robustness_after",
    "frequency_before_rad_s",
    "frequency_after_rad_s",
    "algebraic_loop_radius",
    "algebraic_loop_radius_per_joint",
    "lag_margin_s",
    "lag_limit_s",
    "closed_loop_abscissa",
}


def test_exact_reference(call: Call) -> None:
    outcome = call(*AT, "--method", "exact", "--natural-frequency", "346.8", "--json")
    found = outcome.document("design")
    assert (outcome.status, outcome.err) == (0, "")
    assert found["method"] == "exact"
    np.testing.assert_allclose(found["E"], [[0.164677, 0.016120], [0.016120, -0.059773]], atol=1e-6)
    assert set(found["certificate"]) >= CERTIFICATE
    assert abs(found["certificate"]["robustness_after"][0]) < 1e-12
    assert found["certificate"]["frequency_after_rad_s"][0] == pytest.approx(346.8, rel=1e-9)
    assert found["certificate"]["robustness_before"] == pytest.approx([-0.0708320860], rel=1e-9)


def test_tables(call: Call) -> None:
    shown = call(*AT, "--natural-frequency", "346.8")
    for words in ("0.164677131", "E [kg m^2]", "346.8", "0.062976", "stable here"):
        assert words in shown.out
    assert max(map(len, shown.out.splitlines())) <= 80


def test_infeasible_is_an_answer(call: Call) -> None:
    said = call(*AT, "--natural-frequency", "290")
    assert (said.status, said.out) == (1, "")
    assert said.err.startswith("error: natural frequency 290 rad/s is out of reach")
    answer = call(*AT, "--natural-frequency", "290", "--json")
    assert answer.status == 1
    assert set(found := answer.document("design")) == {"infeasible"}
    assert "300.32" in found["infeasible"]


def test_round_trip_through_the_file(call: Call, compensator_file: Path) -> None:
    found = call("modes", "ueda2003", "--tip", TIP, "--compensator", compensator_file, "--json").document("modes")
    assert found["modes"][0]["frequency_rad_s"] == pytest.approx(346.8, rel=1e-9)
    assert found["positive_real"] is True
    np.testing.assert_allclose(found["modes"][0]["residue"], [[0.036302, 0.047918], [0.047918, 0.063252]], atol=1e-6)
    assert fb.load_compensator(compensator_file).robot == "ueda2003"


def test_options_reach_the_method(call: Call) -> None:
    """Another seed, another path: the estimated slopes differ; exact ones do not depend on it."""
    short = (*AT, "--method", "recursive", "--iterations", "30", "--step", "0.1", "--json")
    one, two = (call(*short, "--seed", seed).document("design")["E"] for seed in "12")
    assert one != two
    exact = [call(*short, "--seed", seed, "--derivatives", "exact").document("design")["E"] for seed in "12"]
    assert exact[0] == exact[1]


def test_task_priority_takes_one_frequency_a_mode(call: Call, tmp_path: Path) -> None:
    words = ("--method", "task-priority", "--iterations", "200")
    found = call(*AT, *words, "--natural-frequency", "330", "--json").document("design")
    assert found["certificate"]["frequency_after_rad_s"][0] == pytest.approx(
        330.0, rel=0.02
    )  # 0.98^200 of the way left
    wrong = call(*AT, *words, "--natural-frequency", "330,340")
    assert (wrong.status, wrong.out) == (2, "")
    assert "2 values given, 1 needed" in wrong.err


def test_smaller_loop_radius_by_its_objective(call: Call) -> None:
    radii = [
        call(*AT, "--objective", objective, "--json").document("design")["certificate"]["algebraic_loop_radius"]
        for objective in ("least-gain", "least-radius")
    ]
    assert radii[1] < radii[0]


def test_lag_bounds_the_frequency(call: Call) -> None:
    """0.3 ms leaves frequencies up to 319.35 rad/s; a share of 0.9 leaves more; the table shows the limit."""
    half = call(*AT, "--lag", "3e-4", "--json").document("design")["certificate"]
    assert half["frequency_after_rad_s"][0] == pytest.approx(319.3492, rel=1e-5)
    assert half["lag_limit_s"] == pytest.approx(6e-4, rel=1e-4)
    most = call(*AT, "--lag", "3e-4", "--lag-share", "0.9", "--json").document("design")["certificate"]
    assert most["frequency_after_rad_s"][0] > half["frequency_after_rad_s"][0]
    assert "lag that takes a mode's whole damping" in call(*AT).out
    refused = call(*AT, "--lag", "3e-4", "--natural-frequency", "346.8")
    assert (refused.status, refused.out) == (1, "")
    assert "a lag of 0.3 ms may take 50 % of the damping" in refused.err
    wrong = call(*AT, "--method", "bounded", "--lag", "3e-4")
    assert (wrong.status, wrong.out) == (2, "")


def test_gains_of_the_loop(call: Call) -> None:
    """One gain given: the project's own completes it; the closed loop is that of the library."""
    own = call(*AT, "--json").document("design")["certificate"]["closed_loop_abscissa"]
    soft = call(*AT, "--stiffness", "1e3,1e3", "--json").document("design")["certificate"]["closed_loop_abscissa"]
    same = call(*AT, "--stiffness", "1e5,1e5", "--damping", "1.5e3,1.5e3", "--json").document("design")
    assert soft != own
    assert same["certificate"]["closed_loop_abscissa"] == own


def test_warning_stands_on_stderr_in_one_line(call: Call) -> None:
    """rho >= 1 at 500 rad/s: one warning, once, and stdout stays one document."""
    outcome = call(*AT, "--method", "recursive", "--natural-frequency", "500", "--iterations", "300", "--json")
    (line,) = [line for line in outcome.err.splitlines() if "algebraic-loop" in line]
    assert line.startswith("warning: ")
    assert all(line.startswith("warning: ") for line in outcome.err.splitlines())
    assert ".py" not in outcome.err
    assert outcome.document("design")["certificate"]["algebraic_loop_radius"] > 1.0
