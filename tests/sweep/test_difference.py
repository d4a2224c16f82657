"""Differences of sweeps: after minus before, with what changes its status told apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.sweeps.answers.angles import crossing
from flexbase.sweeps.answers.chart import chart_of, thinned
from flexbase.sweeps.engine.status import GAINED, LOST, OK, UNREACHABLE

ASKED = {"measures": ("robustness", "frequency", "exact_gain"), "cells": fb.Cells(shape=(41, 41))}


@pytest.fixture(scope="module")
def exact(paper_pose) -> fb.Compensator:
    return fb.design(paper_pose, "exact", natural_frequency=346.8)


@pytest.fixture(scope="module")
def pair(paper, exact):
    return fb.sweep(paper, **ASKED), fb.sweep(paper, **ASKED, loop=exact)


def test_values_are_those_of_the_scalar_path(paper, exact, pair):
    """Modes of single poses, by another code path, to rounding (condition numbers here are below 1e4)."""
    change = fb.difference(*pair)
    both = np.argwhere(change.status.values == OK)
    for row, column in both[:: len(both) // 15]:
        pose = paper.at_tip([change.x.values[column], change.y.values[row]])
        before, after = fb.modes(pose).modes[0], fb.modes(pose, exact).modes[0]
        assert change.robustness.values[row, column, 0] == pytest.approx(
            after.robustness - before.robustness, abs=1e-11
        )
        assert change.frequency.values[row, column, 0] == pytest.approx(after.frequency - before.frequency, abs=1e-9)


def test_status_says_where_they_disagree(paper, exact, pair):
    """M - E by its eigenvalues: NumPy's, not the sweep's pivots."""
    change = fb.difference(*pair)
    lost = np.argwhere(change.status.values == LOST)
    assert len(lost) > 100
    for row, column in lost[::20]:
        M = paper.at_tip([change.x.values[column], change.y.values[row]]).M
        E = np.zeros_like(M)
        E[1:, 1:] = exact.E
        assert np.linalg.eigvalsh(M - E)[0] < 0.0
    assert np.array_equal(change.status.values == UNREACHABLE, pair[0].status.values == UNREACHABLE)
    back = fb.difference(*reversed(pair))
    assert np.array_equal(back.status.values == GAINED, change.status.values == LOST)
    assert "ok before only" in fb.summary(change)


def test_it_is_a_sweep_again(pair, tmp_path):
    """Its file comes back the same, and it is drawn diverging about zero."""
    from flexbase.sweeps import save_netcdf

    change = fb.difference(*pair)
    save_netcdf(change, tmp_path / "change.nc")
    again = fb.open_dataset(tmp_path / "change.nc")
    assert again.equals(change)
    layers = {layer.name: layer for layer in chart_of(again).layers}
    assert {layer.zero_is for layer in layers.values()} == {"no change"}
    assert "with compensator minus without compensator" in chart_of(again).heading


def test_nothing_changes_against_itself(pair):
    change = fb.difference(pair[0], pair[0])
    assert np.nanmax(np.abs(change.robustness.values)) == 0.0
    assert np.array_equal(change.status.values, pair[0].status.values)


def test_angles_differ_by_the_shorter_way(paper, exact):
    asked = {"measures": ["turn"], "cells": fb.Cells(shape=(31, 31))}
    before, after = fb.sweep(paper, **asked), fb.sweep(paper, **asked, loop=exact)
    change = fb.difference(before, after).turn.values
    known = np.isfinite(change)
    assert np.abs(change[known]).max() <= np.pi
    turned = np.exp(1j * (after.turn.values - before.turn.values))
    assert np.exp(1j * change[known]) == pytest.approx(turned[known], abs=1e-12)
    assert np.isnan(crossing("turn", np.array([3.0]))).all()  # near the jump no sign change is a zero


@pytest.mark.parametrize(
    ("other", "said"),
    [
        ({"shape": (41, 40)}, "y has 41 values.*40 values.*same bounds and shape"),
        ({"shape": (41, 41), "bounds": (0, 1, 0, 1)}, "Give both sweeps the same"),
        ({"measures": ["damping"]}, "after has damping. Sweep a measure in both"),
        ({"shape": (4, 4), "over": "joints"}, "before has the axes y, x, after q3, q2"),
    ],
)
def test_other_cells_are_refused(paper, pair, other, said):
    measures = other.pop("measures", ["robustness"])
    with pytest.raises(fb.InputError, match=said):
        fb.difference(pair[0], fb.sweep(paper, measures, fb.Cells(**{"shape": (41, 41), **other})))


def test_what_is_no_sweep_is_refused(pair):
    with pytest.raises(fb.InputError, match="no sweep"):
        fb.difference(pair[0].drop_vars("status"), pair[0])


def test_samples_are_compared_sample_by_sample(paper, exact):
    asked = {"cells": fb.Cells(over="samples", shape=[50])}
    change = fb.difference(fb.sweep(paper, **asked), fb.sweep(paper, **asked, loop=exact))
    assert (change.status.values == OK).sum() > 10
    with pytest.raises(fb.InputError, match="q2 has 50 values"):
        fb.difference(fb.sweep(paper, **asked), fb.sweep(paper, cells=replace(asked["cells"], seed=1)))


def test_thinning_is_even_and_reads_nothing(paper, tmp_path):
    """A store is thinned before it is read; the ends stand equally far out."""
    whole = fb.sweep(
        paper, ["robustness", "turn"], fb.Cells(shape=(230, 170)), execution=fb.Execution(store=tmp_path / "a.zarr")
    )
    assert list(whole.data_vars) == ["status", "robustness", "turn"]  # the order asked for
    part = thinned(whole, largest=50)
    assert part.sizes["x"] <= 50
    assert part.sizes["y"] <= 50
    kept = np.searchsorted(whole.x.values, part.x.values)
    assert len(set(np.diff(kept))) == 1
    assert abs(kept[0] - (229 - kept[-1])) <= 1
    assert not part.robustness._in_memory
    chart = chart_of(whole, largest=50)
    assert np.array_equal(chart.layers[0].values, part.robustness.values[..., 0], equal_nan=True)
    assert chart.cells == "230 x 170"


def test_an_unfinished_store_says_so(paper, tmp_path):
    import zarr

    fb.sweep(paper, cells=fb.Cells(shape=(9, 9)), execution=fb.Execution(store=tmp_path / "a.zarr"))
    zarr.open_group(tmp_path / "a.zarr", mode="r+")["finished_blocks"][0] = 0
    with pytest.warns(fb.FlexbaseWarning, match="1 of 1 blocks are missing"):
        fb.open_dataset(tmp_path / "a.zarr")


@pytest.mark.parametrize("content", [None, "folder", b"CDF\x01 torn"])
def test_what_is_no_store_is_named(tmp_path, content):
    place = tmp_path / "a.nc"
    if content == "folder":
        place.mkdir()
    elif content is not None:
        place.write_bytes(content)
    with pytest.raises(fb.InputError, match=r"a\.nc: is no sweep"):
        fb.open_dataset(place)
