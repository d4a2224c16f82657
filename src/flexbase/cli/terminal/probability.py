"""A Monte Carlo study in words and numbers, and the files it is written to."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from rich.console import RenderableType

from flexbase.cli.terminal.out import PICTURES, write_out
from flexbase.cli.terminal.show import facts, table, title
from flexbase.plant import Plant, Pose
from flexbase.study.montecarlo import LEVELS, Estimate, MonteCarlo
from flexbase.sweeps.engine.status import STATUS

KINDS = (*PICTURES, ".csv", ".json", ".nc")
COVERS = "  Intervals (95 %) cover the finite number of draws, not wrong distributions."


def tables(found: MonteCarlo, place: Plant | Pose) -> list[RenderableType]:
    """Heading, what was asked, and probabilities with their intervals."""
    said = found.dataset.attrs
    asked = [
        ("varied", said["vary"].replace("; ", "\n")),
        ("to hold", said["criteria"].replace("; ", "\n")),
        ("draws", f"{found.dataset.sizes['draw']}, {said['sampling']}, seed {said['seed']}"),
    ]
    heading = title(said["robot"], f"{said['design']}, probability that it holds")
    if isinstance(place, Pose):
        rows = [_row("all", found.at_pose), *(_row(name, one) for name, one in found.by_criterion.items())]
        numbers = table(["criterion", "probability", "from", "to"], rows)
        holds = "holds" if found.dataset["nominal"].values.item() else "does not hold"
        return [heading, "", facts(place.where.rows), "", facts([*asked, ("unvaried", holds)]), numbers, COVERS]
    status = found.dataset["status"].values
    cells = [(meaning, f"{count} cells") for code, meaning in STATUS.items() if (count := np.sum(status == code))]
    cells.append(("unvaried", f"holds in {int(found.dataset['nominal'].values.sum())} cells"))
    rows = [_row("expected", found.expected_share)]
    rows += [_row(f"probability >= {level:g}", found.share_at_least(level)) for level in LEVELS]
    numbers = table(["that holds", "share of workspace", "from", "to"], rows)
    return [heading, "", facts([*asked, *cells]), numbers, COVERS]


def _row(name: str, one: Estimate) -> list[str]:
    return [name, *(f"{value:.4f}" if np.isfinite(value) else "none" for value in one)]


def write_probability(out: Path | None, found: MonteCarlo) -> None:
    """Write a study as its suffix says. Raises InputError."""
    if out is not None and out.suffix.lower() == ".nc":
        found.save_netcdf(out)
    else:
        write_out(out, "montecarlo", found, found.to_dict() if out and out.suffix.lower() == ".json" else {})
