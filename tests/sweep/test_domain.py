"""Cells become inputs: the same ones however a sweep is cut into blocks."""

from __future__ import annotations

import numpy as np
import pytest

import flexbase as fb
from flexbase.sweeps.cells.axis import block_shape, boxes, extent
from flexbase.sweeps.cells.domain import HALTON, RANDOM, Samples
from flexbase.sweeps.cells.grids import place_of


@pytest.mark.parametrize("shape", [(7,), (5, 6), (3, 4, 5), (1, 9)])
@pytest.mark.parametrize("cells", [1, 4, 7, 1000])
def test_blocks_cover_every_cell_once(shape: tuple[int, ...], cells: int) -> None:
    counted = np.zeros(shape, dtype=int)
    for _, box in boxes(shape, block_shape(shape, cells)):
        assert np.prod(extent(box)) <= max(cells, 1)
        counted[tuple(slice(*ends) for ends in box)] += 1
    assert np.all(counted == 1)


def test_grid_inputs_are_the_meshgrid(paper: fb.Plant) -> None:
    place = place_of(
        paper,
        fb.Cells(over="joints", shape=(4, 3), bounds=(0.0, 1.0, 2.0, 3.0), vary={"payload": (0.0, 2.0, 5)}),
    )
    inputs, reached = place.domain.inputs(((1, 4), (0, 3), (1, 3)))
    assert reached is None
    payload, second, first = np.meshgrid(
        np.linspace(0.0, 2.0, 5)[1:4], np.linspace(2.0, 3.0, 3), np.linspace(0.0, 1.0, 4)[1:3], indexing="ij"
    )
    assert np.array_equal(inputs, [first.ravel(), second.ravel(), payload.ravel()])


@pytest.mark.parametrize("sampling", [RANDOM, HALTON])
def test_samples_do_not_depend_on_blocks(sampling: str) -> None:
    low, high = np.array([-1.0, 0.0, 5.0, 2.0, -3.0]), np.array([1.0, 0.1, 6.0, 2.0, 3.0])
    domain = Samples(1000, tuple("abcde"), ("rad",) * 5, low, high, sampling, 3)
    whole, _ = domain.inputs(((0, 1000),))
    parts = np.concatenate([domain.inputs((ends,))[0] for ends in ((0, 333), (333, 334), (334, 1000))], axis=1)
    assert np.array_equal(parts, whole)
    assert np.all((whole >= low[:, None]) & (whole <= high[:, None]))
    middle = (whole.mean(axis=1) - low) / np.where(high > low, high - low, 1.0)
    assert middle[:3] == pytest.approx(0.5, abs=0.05)  # five standard errors of 1000 uniform numbers
    other = Samples(1000, tuple("abcde"), ("rad",) * 5, low, high, sampling, 4).inputs(((0, 1000),))[0]
    assert not np.array_equal(other, whole)


def test_tip_cells_of_a_spatial_arm_reach_their_targets() -> None:
    """Joints of every reached cell bring the tip where the cell says, to 1e-9 m."""
    plant = fb.load("ur5e-pedestal")
    place = place_of(
        plant,
        fb.Cells(shape=(5, 4), bounds=(0.3, 0.5, -0.2, 0.2), hold=(1.2,), vary={"payload": (0.0, 1.0, 2)}),
    )
    inputs, reached = place.domain.inputs(((0, 2), (0, 4), (0, 5)))
    assert reached is not None
    assert reached.reshape(2, -1).sum(axis=1).min() >= 16
    y, x = np.meshgrid(np.linspace(-0.2, 0.2, 4), np.linspace(0.3, 0.5, 5), indexing="ij")
    for cell in np.flatnonzero(reached[:20]):
        tip = plant.at(inputs[:6, cell]).tip
        assert tip == pytest.approx([x.ravel()[cell], y.ravel()[cell], 1.2], abs=1e-9)
    assert np.array_equal(inputs[:6, :20], inputs[:6, 20:])
    assert np.array_equal(np.unique(inputs[6]), [0.0, 1.0])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"over": "tips"}, 'over: "tips" is unknown'),
        ({"axes": ("z",)}, 'no task row "z"'),
        ({"axes": ("x", "x")}, "twice"),
        ({"shape": (3,)}, "2 counts"),
        ({"shape": (3, 0)}, "2 counts"),
        ({"bounds": (0.0, 1.0, 1.0, 0.0)}, "low below its high"),
        ({"bounds": (0.0, 1e9, 0.0, 1.0)}, "nearer"),
        ({"vary": {"mass": (0.0, 1.0, 2)}}, 'no parameter "mass"'),
        ({"vary": {"stiffness": (-1.0, 1.0, 2)}}, "stiffness from -1"),
        ({"over": "samples", "sampling": "dice"}, 'sampling: "dice"'),
        ({"engine": "steam"}, 'engine: "steam"'),
        ({"shape": (10_000, 10_000)}, "kept in memory"),
        ({"shape": 7}, "shape: 7 is not"),
        ({"shape": (3.5, 3)}, "shape"),
        ({"vary": {"payload": (0.0, 1.0)}}, "vary"),
        ({"branch": "up"}, "branch"),
        ({"over": "joints", "branch": "-"}, "joints are given here, so there is no side"),
        ({"seed": -1}, "seed: -1 is below 0"),
        ({"resume": True}, "nothing to resume"),
        ({"workers": 0}, "workers: 0"),
        ({"workers": 2, "scheduler": "tcp://127.0.0.1:9"}, "a scheduler is given too"),
        ({"workers": 1.5}, "workers: 1.5"),
        ({"measures": ["robustnes"]}, "robustness"),
        ({"measures": fb.Cells(shape=(3, 3))}, "measures: Cells given.* cells=Cells"),
    ],
)
def test_wrong_questions_are_refused(paper: fb.Plant, options: dict, message: str) -> None:
    measures = options.pop("measures", ["robustness"])
    execution = fb.Execution(
        **{name: options.pop(name) for name in ("engine", "resume", "workers", "scheduler") if name in options}
    )
    with pytest.raises(fb.InputError, match=message):
        fb.sweep(paper, measures, fb.Cells(**options), execution=execution)


def test_one_axis_three_axes_and_samples(paper: fb.Plant) -> None:
    line = fb.sweep(paper, cells=fb.Cells(over="joints", axes=("q3",), shape=(50,), hold=(0.2, 0.0)))
    assert line["robustness"].dims == ("q3", "mode")
    cube = fb.sweep(paper, cells=fb.Cells(shape=(6, 5), vary={"stiffness": (0.5, 2.0, 4)}))
    assert dict(cube.sizes) == {"stiffness": 4, "y": 5, "x": 6, "mode": 1}
    rising = cube["robustness"].isel(mode=0, x=4, y=3).values  # w does not depend on the stiffness, omega does
    assert rising == pytest.approx(rising[0], rel=1e-12)
    drawn = fb.sweep(paper, ["frequency"], fb.Cells(over="samples", shape=(40,), vary={"stiffness": (0.5, 2.0, 1)}))
    assert drawn["q2"].dims == ("sample",)
    for i in range(0, 40, 10):
        joints = [float(drawn["q2"][i]), float(drawn["q3"][i])]
        nominal = fb.modes(paper.at(joints))[0].frequency
        expected = nominal * np.sqrt(float(drawn["stiffness"][i]))
        assert float(drawn["frequency"][i, 0]) == pytest.approx(expected, rel=1e-9)


def test_rows_are_used_where_the_compiler_is_missing(paper: fb.Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    """Auto falls back with a word; compiled, asked for by name, is refused with the mend."""
    import sys

    monkeypatch.setitem(sys.modules, "llvmlite.binding", None)
    with pytest.warns(fb.FlexbaseWarning, match="fast"):
        found = fb.sweep(paper, cells=fb.Cells(shape=(500, 500)))
    assert "rows" in found.attrs["flexbase_recipe"]
    with pytest.raises(fb.MissingExtra, match="fast"):
        fb.sweep(paper, cells=fb.Cells(shape=(5, 5)), execution=fb.Execution(engine="compiled"))
