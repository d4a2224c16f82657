"""The answer of a Monte Carlo study: probabilities of cells, and what they come to over the workspace."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeGuard

import numpy as np

from flexbase.errors import InputError
from flexbase.sheets.plain import plain
from flexbase.sheets.sheet import Column, Note, Sheet, facts, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.study.montecarlo.interval import CONFIDENCE, Estimate, probability_interval
from flexbase.sweeps.answers.summary import counts
from flexbase.sweeps.answers.tables import check_small, dims_of, places_of, save_netcdf, write_columns
from flexbase.sweeps.engine.status import INFEASIBLE, OK, STATUS, statuses_of

if TYPE_CHECKING:
    import xarray

AT = ("joints", "tip")  # attributes that say where a single pose is
LEVELS = (0.5, 0.9, 0.95, 0.99)


@dataclass(frozen=True, eq=False)
class MonteCarlo(Told):
    """Probability that a design holds, at one pose or in every cell of a map. Made by `montecarlo`.

    dataset : an `xarray.Dataset`. Of each cell: `probability` with the bounds `lower` and `upper`, `held` (draws that
        hold), `criterion_probability` (of each criterion by itself), `nominal` (1 where the plant as it is holds) and
        `status`. Of each draw: its parameters, and `share` of the workspace that holds in it; at a pose 0 or 1.

    Intervals cover, with 95 %, what the finite number of draws leaves open. They say nothing about distributions that
    are wrong, or a model that is.
    """

    dataset: xarray.Dataset

    @property
    def is_map(self) -> bool:
        """Whether it has cells, or is about one pose."""
        return bool(self.dataset["probability"].ndim)

    @property
    def at_pose(self) -> Estimate:
        """Of one pose, or of a map's single cell. Raises InputError for more."""
        if self.dataset["probability"].size != 1:
            raise InputError("at_pose: this is a map. Read its cells from dataset.probability, or ask share_at_least.")
        return Estimate(*(float(self.dataset[name].values.item()) for name in ("probability", "lower", "upper")))

    @property
    def by_criterion(self) -> dict[str, Estimate]:
        """Of one pose, or of a map's single cell: each criterion by itself. Raises InputError for more."""
        self.at_pose  # noqa: B018
        draws = int(self.dataset.sizes["draw"])
        values = self.dataset["criterion_probability"].values.ravel()
        lower, upper = probability_interval(np.rint(values * draws).astype(np.int64), draws)
        names = self.dataset["criterion"].values.tolist()
        return {name: Estimate(*map(float, row)) for name, *row in zip(names, values, lower, upper, strict=True)}

    @property
    def cells(self) -> int:
        """Cells of the workspace: reached and not singular. A cell for which no design exists is one that fails."""
        status = self.dataset["status"].values
        return int(np.count_nonzero((status == OK) | (status == INFEASIBLE)))

    @property
    def expected_share(self) -> Estimate:
        """Mean over all draws of the share of the workspace that holds; each draw is one observation."""
        attributes = self.dataset.attrs
        return Estimate(*(float(attributes[f"expected_share{end}"]) for end in ("", "_lower", "_upper")))

    def share_at_least(self, level: float) -> Estimate:
        """Share of the workspace in which the design holds with a probability of at least `level`.

        Bounds: the share whose lower, and whose upper, bounds reach the level. Exact where cells fail in the same order
        in every draw, as under one dominating parameter, since all cells share the draws; elsewhere mostly too wide.
        Raises InputError.
        """
        if not 0.0 < level <= 1.0:
            raise InputError(f"level: {level} is no probability. Give one above 0, up to 1.")
        parts = (self.dataset[name].values for name in ("probability", "lower", "upper"))
        cells = self.cells
        with np.errstate(invalid="ignore"):
            counts = [int(np.count_nonzero(part >= level)) for part in parts]
        return Estimate(*(count / cells if cells else float("nan") for count in counts))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers; cells without a value hold None. The draws are left out: they are in the dataset."""
        found, attributes = self.dataset, self.dataset.attrs
        check_small(found)
        said = {
            "robot": attributes["robot"],
            "design": attributes["design"],
            "vary": attributes["vary"].split("; "),
            "criteria": attributes["criteria"].split("; "),
            "samples": int(found.sizes["draw"]),
            "sampling": attributes["sampling"],
            "seed": int(attributes["seed"]),
            "confidence": CONFIDENCE,
            "axes": [
                {"name": name, "unit": found[name].attrs["units"], "values": found[name].values.tolist()}
                for name in reversed(dims_of(found))
            ],
            "status": found["status"].values.tolist(),
            "status_codes": {str(code): STATUS[code] for code in STATUS},
            "nominal": found["nominal"].values.tolist(),
            "held": found["held"].values.tolist(),
        }
        said |= {name: plain(found[name].values) for name in ("probability", "lower", "upper")}
        names = found["criterion"].values.tolist()
        said["by_criterion"] = {name: plain(found["criterion_probability"].values[i]) for i, name in enumerate(names)}
        if self.is_map:
            said["cells"] = self.cells
            said["expected_share"] = plain(self.expected_share)
            said["share_at_least"] = {f"{level:g}": plain(self.share_at_least(level)) for level in LEVELS}
        return said

    def sheet(self) -> Sheet:
        """What was asked, and probabilities with their intervals."""
        found, said = self.dataset, self.dataset.attrs
        asked = [
            *((name, said[name]) for name in AT if name in said),
            ("varied", said["vary"].replace("; ", "\n")),
            ("to hold", said["criteria"].replace("; ", "\n")),
            ("draws", f"{found.sizes['draw']}, {said['sampling']}, seed {said['seed']}"),
        ]
        nominal = found["nominal"].values
        if self.is_map:
            meanings = statuses_of(found)
            asked += [(meanings[code], f"{count} cells") for code, count in counts(found).items()]
            asked += [("unvaried", f"holds in {int(nominal.sum())} cells")]
            columns = (words("that holds"), Column("share of workspace"), Column("from"), Column("to"))
            told = {f"probability >= {level:g}": self.share_at_least(level) for level in LEVELS}
            told = {"expected": self.expected_share, **told}
        else:
            asked += [("unvaried", "holds" if nominal.item() else "does not hold")]
            columns = (words("criterion"), Column("probability"), Column("from"), Column("to"))
            told = {"all": self.at_pose, **self.by_criterion}
        rows = [
            (name, *(f"{value:.4f}" if np.isfinite(value) else "none" for value in one)) for name, one in told.items()
        ]
        return make_sheet(
            said["robot"],
            f"{said['design']}, probability that it holds",
            facts(*asked),
            table(columns, rows),
            Note(f"Intervals ({100.0 * CONFIDENCE:g} %) cover the finite number of draws, not wrong distributions."),
            cautions=str(said.get("cautions", "")).splitlines(),
        )

    def save_csv(self, path: str | Path) -> None:
        """A map: one line a cell. A pose: one line a draw, with its parameters. Raises InputError."""
        found = self.dataset
        if not self.is_map:
            drawn = {str(name): found[name].values for name in found.coords if found[name].dims == ("draw",)}
            return write_columns(path, {**drawn, "holds": found["share"].values.astype(int)})
        check_small(found)
        columns = places_of(found)
        columns |= {name: found[name].values for name in ("probability", "lower", "upper", "held", "nominal", "status")}
        each = zip(found["criterion"].values.tolist(), found["criterion_probability"].values, strict=True)
        return write_columns(path, columns | {f"probability_{name}": values for name, values in each})

    def save_netcdf(self, path: str | Path) -> None:
        """The dataset as one NetCDF file, whole or not at all. Raises InputError."""
        save_netcdf(self.dataset, path)


def is_study(dataset: object) -> TypeGuard[xarray.Dataset]:
    """Whether an `xarray.Dataset` is that of a `MonteCarlo`: `MonteCarlo(dataset)` then speaks for it again."""
    return isinstance(dataset, Mapping) and "criterion_probability" in dataset
