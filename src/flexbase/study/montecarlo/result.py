"""The answer of a Monte Carlo study: probabilities of cells, and what they come to over the workspace."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.study.montecarlo.interval import CONFIDENCE, Estimate, probability_interval
from flexbase.sweeps.answers.summary import save_netcdf
from flexbase.sweeps.engine.status import INFEASIBLE, OK, STATUS

LEVELS = (0.5, 0.9, 0.95, 0.99)
LARGEST = 4_000_000  # lines of a table


@dataclass(frozen=True, eq=False)
class Probability:
    """Probability that a design holds, at one pose or in every cell of a map. Made by `montecarlo`.

    dataset : an `xarray.Dataset`. Of each cell: `probability` with the bounds `lower` and `upper`, `held` (draws that
        hold), `criterion_probability` (of each criterion by itself), `nominal` (1 where the plant as it is holds) and
        `status`. Of each draw: its parameters, and `share` of the workspace that holds in it; at a pose 0 or 1.

    Intervals cover, with 95 %, what the finite number of draws leaves open. They say nothing about distributions that
    are wrong, or a model that is.
    """

    dataset: Any

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
        _check_size(found["probability"].size)
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
                for name in reversed(found["probability"].dims)
            ],
            "status": found["status"].values.tolist(),
            "status_codes": {str(code): STATUS[code] for code in STATUS},
            "nominal": found["nominal"].values.tolist(),
            "held": found["held"].values.tolist(),
        }
        said |= {name: _with_none(found[name].values) for name in ("probability", "lower", "upper")}
        names = found["criterion"].values.tolist()
        said["by_criterion"] = {
            name: _with_none(found["criterion_probability"].values[i]) for i, name in enumerate(names)
        }
        if self.is_map:
            said["cells"] = self.cells
            said["expected_share"] = _plain(self.expected_share)
            said["share_at_least"] = {f"{level:g}": _plain(self.share_at_least(level)) for level in LEVELS}
        return said

    def summary(self) -> str:
        """Plain text: what was asked, and what came out."""
        attributes = self.dataset.attrs
        draws = f"{self.dataset.sizes['draw']} draws, seed {attributes['seed']}"
        lines = [f"{attributes['robot']}, {attributes['design']}: {draws}", f"  varied: {attributes['vary']}"]
        lines.append(f"  holds means: {attributes['criteria']}")
        if not self.is_map:
            return "\n".join([*lines, f"  probability {shown(self.at_pose)}"])
        lines += [f"  {self.cells} cells of the workspace; expected share that holds {shown(self.expected_share)}"]
        lines += [f"  holds with probability >= {one:g} in a share {shown(self.share_at_least(one))}" for one in LEVELS]
        return "\n".join(lines)

    def save_csv(self, path: str | Path) -> None:
        """A map: one line a cell. A pose: one line a draw, with its parameters. Raises InputError."""
        found = self.dataset
        if not self.is_map:
            names = [name for name in found.coords if found[name].dims == ("draw",)]
            columns = [found[name].values for name in names] + [found["share"].values.astype(int)]
            return _write(path, [*names, "holds"], columns)
        dims, shape = found["probability"].dims, found["probability"].shape
        names, columns = [], []
        for i, name in reversed(list(enumerate(dims))):
            values = found[name].values.reshape([-1 if j == i else 1 for j in range(len(dims))])
            names.append(name)
            columns.append(np.broadcast_to(values, shape))
        for name in ("probability", "lower", "upper", "held", "nominal", "status"):
            names.append(name)
            columns.append(found[name].values)
        for i, name in enumerate(found["criterion"].values.tolist()):
            names.append(f"probability_{name}")
            columns.append(found["criterion_probability"].values[i])
        return _write(path, names, columns)

    def save_netcdf(self, path: str | Path) -> None:
        """The dataset as one NetCDF file, whole or not at all. Raises InputError."""
        save_netcdf(self.dataset, path)


def is_study(dataset: Any) -> bool:
    """Whether an `xarray.Dataset` is that of a `Probability`: `Probability(dataset)` then speaks for it again."""
    return "criterion_probability" in dataset


def shown(estimate: Estimate) -> str:
    """`0.874 (0.852 to 0.894)`."""
    return f"{estimate.value:.4f} ({estimate.lower:.4f} to {estimate.upper:.4f})"


def _plain(estimate: Estimate) -> dict[str, float]:
    return dict(estimate._asdict())


def _with_none(values: Array) -> Any:
    if values.ndim:
        return [_with_none(part) for part in values]
    return float(values) if np.isfinite(values) else None


def _check_size(lines: int) -> None:
    if lines > LARGEST:
        raise InputError(f"{lines} cells: tables hold up to {LARGEST}. Give fewer, with --shape.")


def _write(path: str | Path, header: Sequence[str], columns: Iterable[np.ndarray]) -> None:
    flat = [column.ravel().tolist() for column in columns]
    _check_size(len(flat[0]))
    try:
        with open(path, "w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(header)
            table.writerows(zip(*flat, strict=True))
    except OSError as fault:
        raise InputError(f"{path}: cannot be written ({fault.strerror}). Give a file in an existing folder.") from fault
