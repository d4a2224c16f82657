"""A compensator and its certificate, as tables."""

from __future__ import annotations

from textwrap import indent

from rich.console import RenderableType

from flexbase.cli.terminal.show import facts, table, title, verdict
from flexbase.control.compensator import Compensator
from flexbase.sheets.numbers import listed, matrix, number

IDEAL = "Continuous time, ideal acceleration."


def tables(found: Compensator, inertia_unit: str) -> list[RenderableType]:
    """Heading, E, the modes before and after, the margins, and whether the task-space loop settles."""
    proof = found.certificate
    before = zip(proof.robustness_before, proof.frequency_before_rad_s, strict=True)
    after = zip(proof.robustness_after, proof.frequency_after_rad_s, strict=True)
    rows = [
        [str(i), *(number(value) for pair in zip(one, other, strict=True) for value in pair)]
        for i, (one, other) in enumerate(zip(before, after, strict=True), start=1)
    ]
    columns = ["mode", "w before\n[m/(N s^2)]", "w after\n", "frequency before\n[rad/s]", "frequency after\n"]
    lag = "no limit to 1 s" if proof.lag_margin_s is None else f"{number(1e3 * proof.lag_margin_s, 6)} ms"
    limit = "none within 1 s" if proof.lag_limit_s is None else f"{number(1e3 * proof.lag_limit_s, 6)} ms"
    loop = proof.closed_loop_abscissa
    margins = [
        ("smallest eigenvalue of M - E", number(proof.min_eig_modified_inertia, 6)),
        ("target residual, relative", number(proof.target_residual, 3)),
        ("algebraic-loop radius, one delay", number(proof.algebraic_loop_radius, 6)),
        ("algebraic-loop radius, a delay a joint", number(proof.algebraic_loop_radius_per_joint, 6)),
        ("lag margin of the acceleration signal", "undefined: no task gains" if loop is None else lag),
        ("lag that takes a mode's whole damping", limit),
        ("closed loop, rightmost pole [1/s]", "undefined: no task gains" if loop is None else number(loop, 6)),
    ]
    said: list[RenderableType] = [
        title(found.robot, f"compensator, method {found.method}, at joints {listed(found.q)}"),
        "",
        *_gain(found, inertia_unit),
        table(columns, rows),
        facts(margins),
        *_statement(proof.statement),
    ]
    if loop is None:
        return said
    return [
        *said,
        "",
        verdict(loop < 0.0, "The task-space loop is stable here", "The task-space loop is unstable here", IDEAL),
    ]


def _statement(text: str) -> list[RenderableType]:
    """What is certain about positive realness, a line of its own."""
    return ["", f"  {text[0].upper()}{text[1:]}"] if text else []


def _gain(found: Compensator, unit: str) -> list[RenderableType]:
    """E beside its name, or below it where it is wide."""
    if len(found.E) <= 4:
        return [facts([(f"E [{unit}]", found.E)])]
    return [f"  E [{unit}], three digits; all of them with --json and --out", indent(matrix(found.E), "    "), ""]
