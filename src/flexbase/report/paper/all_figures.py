"""Reproduce the paper: every panel as a picture with the numbers behind it, and the comparison table."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from flexbase.report import paper as panels
from flexbase.report.paper import numbers_behind as numbers
from flexbase.report.save import make_folder, save_csv, save_figure, save_text
from flexbase.requests import Progress, no_progress
from flexbase.study.paper import (
    Reproduction,
    compare,
    ellipse_field,
    ellipse_tips,
    example,
    robustness_map,
    settling,
    shaping,
)

__all__ = ["PANELS", "Reproduction", "reproduce"]

PANELS = (
    "fig05", "fig06a", "fig06b", "fig07a", "fig07b", "fig07c", "fig08a", "fig08b", "fig09a", "fig09b", "fig10",
)  # fmt: skip
HEADER = ("quantity", "paper", "ours", "difference", "remark")


def reproduce(folder: Path, progress: Progress = no_progress) -> Reproduction:
    """Compute everything, then write `fig*.png`, `fig*.svg`, `fig*.csv`, `table.md` and `table.csv` into a folder.

    progress : called with what is being done, the steps done and all steps
    Takes about a minute, most of it in the recursions of Fig. 10. Raises InputError where the folder cannot be written.
    """
    place = make_folder(folder)
    case = example()
    cells = len(ellipse_tips(case.plant))
    step = _Steps(progress, 3 + cells + len(PANELS))
    step("designing at the work point")
    shaped = shaping(case.pose)
    step("mapping the robustness")
    without, compensated = (robustness_map(case.plant), robustness_map(case.plant, shaped.recursion))
    step("simulating the move")
    settled = settling(case.plant, shaped.recursion)
    field = ellipse_field(case.plant, progress=lambda what, done, total: step(f"{what} {done + 1} of {total}"))
    jobs: dict[str, tuple[Callable[[], Figure], numbers.Numbers]] = {
        "fig05": (lambda: panels.configuration(case), numbers.configuration(case)),
        "fig06a": (lambda: panels.surface(without), numbers.robustness(without)),
        "fig06b": (lambda: panels.contours(without), numbers.robustness(without)),
        **{
            name: (partial(panels.iteration_curve, shaped, curve), numbers.iterations(shaped, curve))
            for name, curve in panels.CURVES.items()
        },
        "fig08a": (lambda: panels.surface(compensated), numbers.robustness(compensated)),
        "fig08b": (lambda: panels.contours(compensated), numbers.robustness(compensated)),
        "fig09a": (lambda: panels.positioning_error(settled.without), numbers.errors(settled.without)),
        "fig09b": (lambda: panels.positioning_error(settled.compensated), numbers.errors(settled.compensated)),
        "fig10": (lambda: panels.ellipses(field, without), numbers.ellipse_table(field)),
    }
    for name in PANELS:
        step(f"drawing {name}")
        draw, behind = jobs[name]
        figure = draw()
        save_figure(figure, place / f"{name}.png")
        save_figure(figure, place / f"{name}.svg")
        save_csv(place / f"{name}.csv", *behind)
    table = compare(case, shaped, settled, field)
    save_csv(place / "table.csv", HEADER, table.summary_rows())
    save_text(place / "table.md", _markdown(table))
    step("done")
    return table


class _Steps:
    """Counts steps for a progress callback: a call says what begins, and that the one before is done."""

    def __init__(self, progress: Progress, total: int) -> None:
        self.progress, self.total, self.done = progress, total, -1

    def __call__(self, doing: str) -> None:
        self.done = min(self.done + 1, self.total)
        self.progress(doing, self.done, self.total)


def _markdown(table: Reproduction) -> str:
    lines = ["| " + " | ".join(HEADER) + " |", "|" + "---|" * len(HEADER)]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in table.summary_rows()]
    return "\n".join(lines) + "\n"
