"""Maps and paths of verdicts: cell by cell the single verdict; stopped and gone on with; refused where they differ."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import flexbase as fb
from flexbase.errors import InputError, Unreachable
from flexbase.model.loop import Loop
from flexbase.model.sensing import Sensing
from flexbase.sampled.verdict import hardware_verdict
from flexbase.sheets.sheet import Table
from flexbase.study.running import hardware_map as module
from flexbase.study.running.hardware_map import MEASURES, hardware_map
from flexbase.synthesis import controller_for

FAST = Sensing(rate=4000.0)


def test_cells_are_single_verdicts(paper: fb.Plant) -> None:
    found = hardware_map(
        paper,
        "none",
        fb.Cells(shape=(4, 3), bounds=(-0.1, 0.5, -0.4, 0.4)),
        loop=Loop(sensing=FAST),
        execution=fb.Execution(workers=1),
    )
    assert found["spectral_radius"].dims == ("y", "x")
    reached = 0
    for j, y in enumerate(found["y"].values):
        for i, x in enumerate(found["x"].values):
            try:
                pose = paper.at_tip([x, y])
            except Unreachable:
                assert found["status"].values[j, i] == 1
                continue
            reached += 1
            expected = hardware_verdict(controller_for(pose, "none", FAST), brief=True)
            assert found["status"].values[j, i] == (0 if expected.stable else module.UNSTABLE)
            for name in MEASURES:
                value = getattr(expected, name)
                assert found[name].values[j, i] == pytest.approx(np.nan if value is None else value, nan_ok=True)
    assert reached >= 6
    assert fb.plot(found).axes


def test_path_and_given_gain(paper: fb.Plant, paper_pose: fb.Pose) -> None:
    comp = fb.design(paper_pose, natural_frequency=346.8)
    near, far = fb.hardware_path(paper, [[0.33, -0.25], [2.0, 2.0]], loop=Loop(comp, sensing=FAST), workers=1).tips
    assert (near.status, far.status) == ("ok", "out of reach")
    assert near.figures["spectral_radius"] == pytest.approx(0.99578, abs=1e-4)  # stable with E, 1.0018 without
    assert far.figures["spectral_radius"] is None
    with pytest.raises(InputError, match="path: 3 values given, 2 needed"):
        fb.hardware_path(paper, [[1.0, 2.0, 3.0]])


def test_stopped_and_gone_on_with(paper: fb.Plant, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An interruption costs its block; the second run computes the others alone; another recipe is refused."""
    monkeypatch.setattr(module, "BLOCK", 4)
    seen = []
    cells = fb.Cells(shape=(4, 3), bounds=(0.1, 0.5, -0.4, 0.4))
    kept = fb.Execution(store=tmp_path / "m.zarr", workers=1)
    loop = Loop(sensing=FAST)

    def stop(what: str, done: int, total: int) -> None:
        if done >= 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        hardware_map(paper, "none", cells, loop=loop, execution=kept, progress=stop)
    again = replace(kept, resume=True)
    found = hardware_map(paper, "none", cells, loop=loop, execution=again, progress=lambda *told: seen.append(told))
    assert seen == [("cells", 4, 12), ("cells", 8, 12), ("cells", 12, 12)]
    whole = hardware_map(paper, "none", cells, loop=loop, execution=fb.Execution(workers=2))
    assert list(whole.data_vars) == list(found.data_vars)
    np.testing.assert_array_equal(found["spectral_radius"].values, whole["spectral_radius"].values)
    with pytest.raises(InputError, match="sensing"):
        hardware_map(paper, "none", cells, loop=Loop(sensing=Sensing(rate=2000.0)), execution=again)
    with pytest.raises(InputError, match="nothing to resume"):
        hardware_map(paper, "none", cells, execution=fb.Execution(resume=True))


@pytest.mark.parametrize(
    ("cells", "said"),
    [
        (fb.Cells(over="joints"), "over: verdicts are mapped over tip"),
        (fb.Cells(vary={"payload": (0.0, 1.0, 2)}), "vary: verdicts are on the plant as it is"),
        ((4, 3), "cells: tuple given. Give a Cells"),
    ],
)
def test_what_a_map_of_verdicts_cannot_vary(paper: fb.Plant, cells: object, said: str) -> None:
    with pytest.raises(InputError, match=said):
        hardware_map(paper, "none", cells)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="engine: poses are asked one by one"):
        hardware_map(paper, execution=fb.Execution(engine="rows"))


def test_a_path_s_table_tells_every_figure(paper: fb.Plant) -> None:
    """Stable, unstable, out of reach: the figures of the single verdict, where they have a meaning."""
    found = fb.hardware_path(paper, [[0.2, 0.4], [0.33, -0.25], [2.0, 2.0]], loop=Loop(sensing=FAST), workers=1)
    assert [one.status for one in found.tips] == ["ok", "unstable", "out of reach"]
    (table,) = (part for part in found.sheet().parts if isinstance(part, Table))
    verdict = hardware_verdict(controller_for(paper.at_tip([0.2, 0.4]), "none", FAST), brief=True)
    assert table.rows[0][2:4] == (
        f"{verdict.spectral_radius:.4f}",
        f"{verdict.disk_margin_torque:.2f} {verdict.disk_margin_sensor:.2f}",
    )
    assert table.rows[0][6] == "100"
    assert table.rows[1][3:] == ("-", f"{found.tips[1].figures['worst_radius']:.4f}", "-", "-", "-")
    assert table.rows[2] == ("2, 2", "out of reach", *["-"] * 6)
    assert [row["status"] for row in found.to_dict()["tips"]] == ["ok", "unstable", "out of reach"]


def test_a_map_says_what_was_judged(paper: fb.Plant) -> None:
    found = hardware_map(
        paper, "none", fb.Cells(shape=(3, 3)), loop=Loop(sensing=FAST), execution=fb.Execution(workers=1)
    )
    assert found.attrs["judged"] == "method none at 4000 Hz"
