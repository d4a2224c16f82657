"""The outcome of the agreement study as a table."""

from __future__ import annotations

from rich.console import RenderableType

from flexbase.cli.terminal.show import facts, table, title, verdict
from flexbase.study.agreement.study import Agreement

ENOUGH, ERROR = 0.98, 0.02


def good(found: Agreement) -> bool:
    """Whether enough of the verdicts come true, and neither error is large."""
    return found.agreement >= ENOUGH and max(found.false_stable_rate, found.false_unstable_rate) <= ERROR


def tables(found: Agreement) -> list[RenderableType]:
    """The confusion table, the errors, and each case that disagrees with what explains it."""
    nudged = found.trial == "nudge"
    counts, control, near = found.confusion(), found.constant_predictor(), found.borderline()
    whole = found.complete()
    rows = [
        [f"called {a}", *(str(counts[f"predicted_{a}_{b}"]) for b in ("settled", "not_settled"))]
        for a in ("stable", "unstable")
    ]
    said = [
        ("unstable, called stable", f"{100 * found.false_stable_rate:.1f} %"),
        ("stable, called unstable", f"{100 * found.false_unstable_rate:.1f} %"),
        ("stable with margins, also changed", f"{whole['settled']} of {whole['cases']} settle"),
        ("within 0.001 of the border", f"{near['agreeing']} of {near['cases']} come true"),
        *([("growth, measured to promised", f"{100 * found.growth_error:.2g} % apart (median)")] * nudged),
        ("always saying " + control["says"], f"{100 * control['agreement']:.1f} %"),
        *(("disagrees", f"case {one['number']}: {one['explanation']['why']}") for one in found.disagreements()),
    ]
    head: list[RenderableType] = [
        title(found.robot, f"linear verdicts against a {found.trial} in MuJoCo, {len(found.cases)} poses"),
        "",
    ]
    end = verdict(good(found), f"{100 * found.agreement:.1f} % come true", f"{100 * found.agreement:.1f} % come true")
    return [*head, table(["", "settled", "not settled"], rows, words=(0,)), facts(said), "", end]
