"""How tables give the figures of a verdict, and what the registry says of each."""

from __future__ import annotations

import pytest

import flexbase as fb
from flexbase.sampled.figures import FIGURES
from flexbase.sampled.judged import judged
from flexbase.sampled.verdict import HardwareVerdict, verdict_of
from flexbase.sheets.sheet import BAD, GOOD, Answer

CELLS = {
    "spectral_radius": [(0.997852, "0.9979"), (1.2, "1.2000")],
    "disk_margin_torque": [(0.456, "0.46"), (0.0, "-")],
    "disk_margin_sensor": [(0.3, "0.30"), (0.0, "-")],
    "delay_margin_s": [(0.001234, "1.23")],
    "lag_margin_s": [(0.02, "20.00")],
    "worst_radius": [(0.99884, "0.9988")],
    "tip_stiffness": [(98700.0, "99")],
    "dynamic_stiffness": [(54000.0, "54")],
    "tip_correction": [(0.956, "96"), (-4.0, "-400")],
    "time_constant_s": [(0.0123, "12.3"), (0.0999, "99.9"), (0.1, "100"), (0.25, "250")],
}


@pytest.mark.parametrize("name", CELLS)
def test_cells_are_in_the_unit_of_their_column(name: str) -> None:
    shown = FIGURES[name].shown
    assert shown is not None
    for value, text in CELLS[name]:
        assert shown.of(value).strip() == text


def test_what_brief_verdicts_and_medians_have() -> None:
    """What takes longest is left out of brief verdicts; studies tabulate what the loop does to the tip."""
    long = {"delay_margin_s", "lag_margin_s", "algebraic_loop_radius", "algebraic_loop_radius_per_joint"}
    assert {name for name, one in FIGURES.items() if not one.brief} == long
    tip = {"tip_stiffness", "dynamic_stiffness", "tip_correction", "time_constant_s"}
    assert {name for name, one in FIGURES.items() if one.of_the_tip} == tip
    assert set(FIGURES) == {*CELLS, *long}


def test_an_unstable_loop_has_no_figures_of_settling() -> None:
    """Those are None without being computed: this judged loop has nothing else."""

    class Unstable:
        stable = False

    settling = {"delay_margin_s", "lag_margin_s", "tip_stiffness", "dynamic_stiffness"}
    for name in settling | {"tip_correction", "time_constant_s"}:
        assert FIGURES[name].run(Unstable()) is None  # type: ignore[arg-type]


def test_a_loop_that_is_at_rest_after_a_sample_has_no_time_constant() -> None:
    """Radius 0; else -h / log(radius): at 1 kHz and a radius of exp(-0.1), 10 ms."""

    class Settled:
        stable, radius = True, 0.0

        class controller:
            class sensing:
                step = 1e-3

    assert FIGURES["time_constant_s"].run(Settled()) is None  # type: ignore[arg-type]
    Settled.radius = 0.9048374180359595
    assert FIGURES["time_constant_s"].run(Settled()) == pytest.approx(0.01, rel=1e-12)  # type: ignore[arg-type]


SPOKEN = [
    (False, True, (), 0.5, "unstable as it runs: spectral radius 0.9979 a sample", BAD),
    (True, True, (), 0.3, "stable as it runs, disk margin 0.30; survives changes of the robot", GOOD),
    (True, True, (), 0.12, "stable as it runs, disk margin 0.12, below 0.3; survives changes of the robot", BAD),
    (True, False, ("a", "b"), 0.5, "stable as it runs, disk margin 0.50; fails with a, b", BAD),
]


@pytest.mark.parametrize(("stable", "survives", "failed", "margin", "said", "tone"), SPOKEN)
def test_the_sentence(
    stable: bool, survives: bool, failed: tuple[str, ...], margin: float, said: str, tone: str
) -> None:
    """Only a safe loop is good."""
    told = {"spectral_radius": 0.997852, "disk_margin_torque": 0.9, "disk_margin_sensor": margin}
    verdict = HardwareVerdict("exact", stable, survives, failed, "a", told)
    assert verdict.statement == said
    assert verdict.answer() == Answer(tone, said[0].upper() + said[1:])


def test_all_figures_are_computed_unless_brief_is_asked(paper_pose: fb.Pose) -> None:
    found = judged(fb.make_controller(paper_pose, "lqg"))
    assert verdict_of(found).figures == {name: one.run(found) for name, one in FIGURES.items()}
    assert {name for name, value in verdict_of(found, brief=True).figures.items() if value is None} == {
        name for name, one in FIGURES.items() if not one.brief
    }
