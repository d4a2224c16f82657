"""`montecarlo` against probabilities that are known, and against plants built one draw at a time."""

from __future__ import annotations

import warnings
from dataclasses import fields, replace

import numpy as np
import pytest
from scipy import stats
from scipy.optimize import brentq

import flexbase as fb
from flexbase.linear.linearise import modified_inertia
from flexbase.linear.margins import algebraic_loop_radius, closed_loop_abscissa
from flexbase.model.base import make_base
from flexbase.model.loop import Gain
from flexbase.study.montecarlo import Criterion, Normal, run, trial
from flexbase.sweeps.cells.parameters import PARAMETERS
from systems.changed import changed

SOFT = stats.truncnorm((PARAMETERS["stiffness"].least - 1.0) / 0.15, np.inf, 1.0, 0.15)  # of `normal(1,0.15)`


@pytest.fixture(scope="module")
def designed(paper_pose: fb.Pose) -> fb.Compensator:
    return fb.design(paper_pose, method="exact", natural_frequency=346.8)


def shortage_with(pose: fb.Pose, E: np.ndarray, name: str, value: float) -> float:
    """Of a plant built with the parameter, from the residue of `fb.modes`."""
    R = fb.modes(changed(pose.plant, name, value).at(pose.q), Gain(E)).modes[0].residue
    return float(0.5 * (1.0 - np.trace(R) / np.linalg.norm(R)))


def test_a_threshold_of_frequency_has_a_known_probability(paper_pose: fb.Pose) -> None:
    """omega = omega_0 sqrt(f): P(omega >= w) = P(f >= (w/omega_0)^2) of the truncated normal; within 4 sigma of it."""
    nominal = fb.modes(paper_pose).modes[0].frequency
    for wanted in (250.0, 275.0, 300.0):
        found = fb.montecarlo(
            paper_pose, fb.Draws({"stiffness": "normal(1,0.15)"}, samples=20_000), criteria=[f"frequency={wanted}:"]
        )
        true = SOFT.sf((wanted / nominal) ** 2)
        assert 0.05 < true < 0.95
        assert found.at_pose.value == pytest.approx(true, abs=4.0 * np.sqrt(true * (1.0 - true) / 20_000))
        between = fb.montecarlo(
            paper_pose, fb.Draws({"stiffness": Normal(1.0, 0.15)}, samples=20_000), criteria=[f"frequency=:{wanted}"]
        )
        assert between.at_pose.value == pytest.approx(1.0 - found.at_pose.value, abs=1e-12)  # the same draws


def test_the_interval_covers_in_repeated_studies(paper_pose: fb.Pose) -> None:
    """Of 400 seeds 95 % cover the known probability: at least 93 %, 2 sigma below; at most 99 %, not merely wide."""
    true = SOFT.sf((300.0 / fb.modes(paper_pose).modes[0].frequency) ** 2)
    covered = 0
    for seed in range(400):
        found = fb.montecarlo(
            paper_pose, fb.Draws({"stiffness": "normal(1,0.15)"}, samples=100, seed=seed), criteria="frequency=300:"
        ).at_pose
        covered += found.lower <= true <= found.upper
    assert 0.93 <= covered / 400 <= 0.99


def test_a_monotone_criterion_has_a_known_probability(paper_pose: fb.Pose, designed: fb.Compensator) -> None:
    """The shortage grows with the payload and passes 0.01 where that of plants built with it does: P follows."""
    payloads = np.linspace(0.0, 6.0, 13)
    rising = [shortage_with(paper_pose, designed.E, "payload", value) for value in payloads]
    assert np.all(np.diff(rising) > 0.0)
    border = brentq(lambda value: shortage_with(paper_pose, designed.E, "payload", value) - 0.01, 0.1, 5.9)
    found = fb.montecarlo(
        paper_pose, fb.Draws({"payload": "uniform(0,6)"}, samples=4096, sampling="sobol"), loop=designed
    )
    assert found.at_pose.value == pytest.approx(border / 6.0, abs=5e-4)
    wider = fb.montecarlo(paper_pose, {"payload": "uniform(0,6)"}, loop=designed, criteria=["robust=0.5"])
    assert wider.at_pose.value == 1.0


def test_every_draw_is_judged_as_its_own_plant_is(paper_pose: fb.Pose, designed: fb.Compensator) -> None:
    """All criteria at once, draw by draw, by the full model of a plant built with the drawn numbers."""
    vary = {"stiffness": "normal(1,0.3)", "payload": "uniform(0,6)", "link_mass.q2": "lognormal(1,0.3)"}
    vary["link_com"] = "normal(1,0.2)"
    E, gains = 1.15 * designed.E, paper_pose.arm.gains
    assert gains is not None
    criteria = ["definite", "robust=0.03", "stable", "loop=0.95", "frequency=:420"]
    found = fb.montecarlo(paper_pose, fb.Draws(vary, samples=150, seed=4), loop=Gain(E), criteria=criteria)
    verdicts = []
    for draw in range(150):
        plant = paper_pose.plant
        for name in ("stiffness", "link_mass.q2", "link_com", "payload"):  # the payload is no part of the last link
            plant = changed(plant, name, float(found.dataset[name][draw]))
        pose = plant.at(paper_pose.q)
        verdict = [np.linalg.eigvalsh(modified_inertia(pose, E))[0] > 0.0]
        if verdict[0]:
            mode = fb.modes(pose, Gain(E)).modes[0]
            verdict += [
                0.5 * (1.0 - mode.alignment) <= 0.03,
                closed_loop_abscissa(pose, E, gains) < 0.0,
                algebraic_loop_radius(pose, E) < 0.95,
                mode.frequency <= 420.0,
            ]
        verdicts.append(verdict if len(verdict) > 1 else [False] * 5)
    each = np.array(verdicts)
    assert np.array_equal(found.dataset["share"].values, each.all(axis=1))
    assert found.dataset["criterion_probability"].values == pytest.approx(each.mean(axis=0), abs=1e-12)
    assert all(5 <= count <= 149 for count in each.sum(axis=0)), each.sum(axis=0)  # each decides something


def test_no_variation_is_certain(paper_pose: fb.Pose, designed: fb.Compensator) -> None:
    """Without variation the probability is 0 or 1 and nothing between; a design for another pose fails."""
    still = {"stiffness": 1.0, "payload": "normal(0,0)"}
    assert fb.montecarlo(paper_pose, still, loop=designed).at_pose.value == 1.0
    assert fb.montecarlo(paper_pose, still).at_pose.value == 0.0  # the bare arm is not robust here
    elsewhere = fb.design(paper_pose.plant.at_tip([0.45, -0.1]), method="exact")
    shaken = {"stiffness": "normal(1,0.15)", "payload": "uniform(0,3)"}
    assert fb.montecarlo(paper_pose, shaken, loop=elsewhere).at_pose.value < 0.01
    assert fb.montecarlo(paper_pose, shaken, loop=designed).at_pose.value > 0.5
    chart = fb.montecarlo(
        paper_pose.plant, fb.Draws(still, samples=3), criteria=["frequency=280:"], cells=fb.Cells(shape=(20, 20))
    ).dataset
    judged = chart["status"].values == 0
    assert set(np.unique(chart["probability"].values[judged])) == {0.0, 1.0}
    assert np.array_equal(chart["probability"].values[judged] == 1.0, chart["nominal"].values[judged] == 1)


def test_springs_do_not_decide_on_robustness_of_one_mode(paper_pose: fb.Pose, designed: fb.Compensator) -> None:
    """With one base joint a and b hang on masses alone; a tolerance at rounding still holds."""
    vary = {"stiffness": "normal(1,0.3)", "damping": "uniform(0,3)"}
    strict = ["robust=1e-12", "frequency=300:"]
    found = fb.montecarlo(paper_pose, fb.Draws(vary, samples=500), loop=designed, criteria=strict).by_criterion
    assert found["robust"].value == 1.0
    assert 0.1 < found["frequency"].value < 0.9


def test_a_base_joint_of_its_own_decides_where_modes_couple() -> None:
    """One factor on all springs leaves mode shapes as they are, so shortage too; a single spring's does not."""
    gantry = fb.load("ur5e-gantry")
    base = gantry.arm.base
    undamped = make_base(base.stiffness, 0.0 * base.damping, base.equilibrium, base.m)
    plant = fb.Plant(replace(gantry.arm, base=undamped))
    pose = plant.at([0.4, -1.2, 1.4, -0.6, -1.4, 0.3])
    names = plant.arm.mechanism.joint_names
    shortage = fb.montecarlo(pose, fb.Draws({"stiffness": 1.0}, samples=1), criteria=["shortage=:0"])
    assert shortage.at_pose.value == 0.0
    before = fb.sweep(
        plant,
        ["shortage"],
        fb.Cells(over="joints", shape=(1, 1), axes=names[2:4], bounds=_here(pose, 0, 1), hold=pose.q[2:]),
    )
    bound = float(before["shortage"].values.item())
    limit = [Criterion("near", "shortage", bound * (1.0 - 1e-9), bound * (1.0 + 1e-9))]
    whole = fb.montecarlo(pose, fb.Draws({"stiffness": "normal(1,0.2)"}, samples=50), criteria=limit)
    single = fb.montecarlo(pose, fb.Draws({f"stiffness.{names[0]}": "normal(1,0.2)"}, samples=50), criteria=limit)
    assert (whole.at_pose.value, single.at_pose.value) == (1.0, 0.0)


def _here(pose: fb.Pose, *joints: int) -> list[float]:
    return [float(pose.q[pose.arm.m + i]) + step for i in joints for step in (0.0, 1e-12)]


def test_a_map_holds_known_probabilities_and_shares(paper: fb.Plant) -> None:
    """Cell by cell P(f >= (w/omega)^2), omega of `sweep`, within 4 sigma; shares of the workspace follow."""
    chart = fb.sweep(paper, ["frequency"], fb.Cells(shape=(31, 33)))
    found = fb.montecarlo(
        paper,
        fb.Draws({"stiffness": "normal(1,0.15)"}, samples=3000),
        criteria=["frequency=280:"],
        cells=fb.Cells(shape=(31, 33)),
    )
    omega = chart["frequency"].values[..., 0]
    assert np.array_equal(found.dataset["status"].values, chart["status"].values)
    true = SOFT.sf((280.0 / omega) ** 2)
    judged = np.isfinite(omega)
    sigma = np.sqrt(true * (1.0 - true) / 3000)[judged]
    assert np.all(np.abs(found.dataset["probability"].values - true)[judged] <= 4.0 * sigma + 1e-3)
    assert np.isnan(found.dataset["probability"].values[~judged]).all()
    assert found.cells == judged.sum()
    share = found.dataset["share"].values
    drawn = found.dataset["stiffness"].values
    assert share == pytest.approx([(np.sqrt(f) * omega[judged] >= 280.0).mean() for f in drawn], abs=1e-12)
    assert found.expected_share.value == pytest.approx(found.dataset["probability"].values[judged].mean(), abs=1e-12)


def test_intervals_of_the_workspace_cover(paper: fb.Plant) -> None:
    """Of 200 seeds, all cells sharing each draw: the mean share, and the share at 50 and 90 %, in at least 92 %.

    That is 2 sigma below 95 %. A binomial interval over cells would fail: it takes cells for independent.
    """
    omega = fb.sweep(paper, ["frequency"], fb.Cells(shape=(25, 25)))["frequency"].values[..., 0]
    true = SOFT.sf((280.0 / omega[np.isfinite(omega)]) ** 2)
    covered = np.zeros(4)
    for seed in range(200):
        found = fb.montecarlo(
            paper,
            fb.Draws({"stiffness": "normal(1,0.15)"}, samples=120, seed=seed),
            criteria="frequency=280:",
            cells=fb.Cells(shape=(25, 25)),
        )
        mean = found.expected_share
        naive = 1.96 * np.sqrt(mean.value * (1.0 - mean.value) / (true.size * 120))
        covered[0] += mean.lower <= true.mean() <= mean.upper
        for i, level in ((1, 0.5), (2, 0.9)):
            one = found.share_at_least(level)
            covered[i] += one.lower <= (true >= level).mean() <= one.upper
        covered[3] += abs(mean.value - true.mean()) <= naive
    assert covered[:3].min() / 200 >= 0.92
    assert covered[3] / 200 < 0.8


def test_intervals_of_the_workspace_cover_with_several_parameters(paper: fb.Plant) -> None:
    """The same where cells fail in another order in each draw; the truth is a study with 60 000 draws."""
    vary = {"payload": "uniform(0,3)", "link_mass.q3": "lognormal(1,0.2)", "link_com.q2": "normal(1,0.1)"}
    asked = {"redesign": True, "cells": fb.Cells(shape=(21, 21)), "criteria": ["definite", "robust=0.05"]}
    truth = fb.montecarlo(paper, fb.Draws(vary, samples=60_000, seed=999), **asked)
    covered = np.zeros(3)
    for seed in range(60):
        found = fb.montecarlo(paper, fb.Draws(vary, samples=150, seed=seed), **asked)
        pairs = [(found.expected_share, truth.expected_share)]
        pairs += [(found.share_at_least(level), truth.share_at_least(level)) for level in (0.5, 0.9)]
        covered += [one.lower <= other.value <= one.upper for one, other in pairs]
    assert covered.min() / 60 >= 0.89  # 2 sigma below 95 %


def test_blocks_threads_and_engines_change_nothing(paper: fb.Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    vary = fb.Draws({"stiffness": "normal(1,0.15)", "payload": "uniform(0,3)"}, samples=301)
    asked = {"redesign": True, "cells": fb.Cells(shape=(23, 29)), "criteria": ["robust", "loop"]}
    whole = fb.montecarlo(paper, vary, **asked, execution=fb.Execution(engine="compiled")).dataset
    rows = fb.montecarlo(paper, vary, **asked, execution=fb.Execution(engine="rows")).dataset
    monkeypatch.setattr(trial, "TOGETHER", 97)
    monkeypatch.setattr(run, "TOGETHER", 97)
    monkeypatch.setattr(run, "LEAST_BLOCK", 7)
    pieces = fb.montecarlo(paper, vary, **asked, execution=fb.Execution(engine="compiled")).dataset
    apart = fb.montecarlo(paper, vary, **asked, execution=fb.Execution(engine="compiled", workers=2)).dataset
    assert pieces.identical(apart)
    assert whole.drop_attrs().identical(pieces.drop_attrs())
    assert whole.attrs == pieces.attrs
    for name in ("held", "status", "share"):
        assert np.array_equal(whole[name], rows[name]), name


def test_the_design_of_each_cell_is_that_of_a_pose(paper: fb.Plant) -> None:
    """A cell of a map with `redesign` is the study of `fb.design` at its pose; without a design it fails."""
    vary = {"payload": "uniform(0,3)", "link_mass": "lognormal(1,0.05)"}
    chart = fb.montecarlo(paper, fb.Draws(vary, samples=400), redesign=True, cells=fb.Cells(shape=(9, 9))).dataset
    status, seen = chart["status"].values, set()
    for row, column in zip(*np.nonzero((status == 0) | (status == 4)), strict=True):
        pose = paper.at_tip([float(chart["x"][column]), float(chart["y"][row])])
        seen.add(int(status[row, column]))
        if status[row, column] == 4:
            with pytest.raises(fb.Infeasible):
                fb.design(pose, method="exact")
            assert np.isnan(chart["probability"].values[row, column])
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", fb.FlexbaseWarning)  # algebraic loops of radius 1 and more
            E = fb.design(pose, method="exact")
        assert fb.montecarlo(pose, fb.Draws(vary, samples=400), loop=E).at_pose.value == pytest.approx(
            float(chart["probability"][row, column]), abs=1.0 / 400
        )
    assert seen == {0, 4}
    assert float(chart["share"].max()) < 1.0


def test_joint_maps_poses_with_another_equilibrium_and_solved_grids(paper: fb.Plant) -> None:
    """Over joints the base's equilibrium is the plant's; a pose keeps its own; six axes go by inverse kinematics."""
    vary = {"payload": "uniform(0,3)"}
    found = fb.montecarlo(
        paper, fb.Draws(vary, samples=50), criteria=["frequency=280:"], cells=fb.Cells(over="joints", shape=(5, 4))
    )
    assert found.dataset["probability"].dims == ("q3", "q2")
    q = [float(found.dataset["q2"][1]), float(found.dataset["q3"][2])]
    assert float(found.dataset["probability"][2, 1]) == pytest.approx(
        fb.montecarlo(paper.at(q), fb.Draws(vary, samples=50), criteria=["frequency=280:"]).at_pose.value
    )
    turned = fb.montecarlo(paper.at([0.7, *q]), fb.Draws(vary, samples=50), criteria=["manipulability=:1e9"])
    assert turned.at_pose.value == 1.0
    arm = fb.load("ur5e-pedestal")
    six = fb.montecarlo(
        arm,
        fb.Draws(vary, samples=20),
        criteria=["frequency=101.5:"],
        cells=fb.Cells(shape=(3, 2), bounds=[0.3, 0.5, 0.1, 0.3], hold=[0.3]),
    )
    assert (six.dataset["status"].values == 0).all()
    chart = fb.sweep(arm, ["frequency"], fb.Cells(shape=(3, 2), bounds=[0.3, 0.5, 0.1, 0.3], hold=[0.3]))
    assert np.array_equal(six.dataset["nominal"].values == 1, chart["frequency"].values[..., 0] >= 101.5)


def test_results_speak(paper: fb.Plant, paper_pose: fb.Pose, designed: fb.Compensator, tmp_path) -> None:
    """Summary, plain numbers, CSV and NetCDF hold the same numbers."""
    import xarray

    vary = {"payload": "uniform(0,3)", "stiffness.q1": "normal(1,0.1)"}
    found = fb.montecarlo(paper, fb.Draws(vary, samples=40), redesign=True, cells=fb.Cells(shape=(7, 6)))
    plain = found.to_dict()
    assert np.shape(plain["probability"]) == (6, 7)
    assert plain["share_at_least"]["0.95"]["value"] == found.share_at_least(0.95).value
    assert f"expected {found.expected_share.value:.4f}" in " ".join(found.summary().split())
    found.save_csv(tmp_path / "m.csv")
    table = np.genfromtxt(tmp_path / "m.csv", delimiter=",", names=True)
    assert len(table) == 42
    assert np.array_equal(table["probability"], found.dataset["probability"].values.ravel(), equal_nan=True)
    assert np.array_equal(
        table["probability_robust"].reshape(6, 7)[0], found.dataset["criterion_probability"][1][0], equal_nan=True
    )
    found.save_netcdf(tmp_path / "m.nc")
    with xarray.open_dataset(tmp_path / "m.nc", engine="scipy") as kept:
        assert np.array_equal(kept["share"], found.dataset["share"])
        assert kept["criterion"].values.astype(str).tolist() == ["definite", "robust"]
    one = fb.montecarlo(paper_pose, fb.Draws(vary, samples=40), loop=designed)
    one.save_csv(tmp_path / "p.csv")
    draws = np.genfromtxt(tmp_path / "p.csv", delimiter=",", names=True, deletechars="")
    assert draws["holds"].mean() == one.at_pose.value
    assert np.array_equal(draws["payload"], one.dataset["payload"])
    assert one.to_dict()["probability"] == one.at_pose.value


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"vary": {}}, "vary: nothing varies"),
        ({"vary": {"stifness": 1}}, 'vary: no parameter "stifness". Did you mean "stiffness"'),
        ({"samples": 0}, "samples: 0 given. Give a whole number from 1"),
        ({"samples": 10.0}, "samples: 10.0 is not a whole number"),
        ({"seed": -1}, "seed: -1 is below 0"),
        ({"sampling": "halton"}, 'sampling: "halton" is unknown'),
        ({"criteria": []}, "criteria: none is given"),
        ({"criteria": ["robust", "robust=0.1"]}, 'criteria: "robust" is given twice'),
        ({"criteria": ["robst"]}, 'criterion: "robst" is unknown. Did you mean "robust"'),
        ({"criteria": ["definite=1"]}, "has a bound, but definite"),
        ({"criteria": ["frequency"]}, "is not frequency=LOW:HIGH"),
        ({"criteria": ["frequency=2:1"]}, "low end above"),
        ({"criteria": ["frequency=a:1"]}, '"a" is not a finite number'),
        ({"criteria": ["axis_rotation=:1"], "robot": "scara", "over": "volume"}, 'over: "volume" is unknown'),
        ({"redesign": True, "loop": Gain(np.eye(2))}, "redesign: a compensator is given too"),
        ({"redesign": True, "robot": "ur5e-gantry"}, "measure exact_gain: one base joint"),
        ({"loop": Gain(np.eye(3))}, r"E has shape \(3, 3\), but ueda2003 has 2 arm joints"),
        ({"shape": (5000, 5000)}, "25000000 cells, up to 4000000"),
        ({"over": "samples"}, 'over: "samples" has no cells'),
        ({"store": "a.zarr"}, "store: a Monte Carlo study is kept in memory"),
        ({"engine": "gpu"}, 'engine: "gpu" is unknown'),
        ({"pose": True, "shape": (3, 3)}, "shape: belongs to a map, but a pose is given"),
    ],
)
def test_wrong_input_is_named(asked: dict, said: str) -> None:
    plant = fb.load(asked.pop("robot", "ueda2003"))
    where = plant.at_tip([0.33, -0.25]) if asked.pop("pose", False) else plant
    vary = asked.pop("vary", {"stiffness": "normal(1,0.1)"})
    draws = {name: asked.pop(name) for name in ("samples", "seed", "sampling") if name in asked}
    parts = {
        name: kind(**{one.name: asked.pop(one.name) for one in fields(kind) if one.name in asked})
        for name, kind in {"cells": fb.Cells, "execution": fb.Execution}.items()
    }
    with pytest.raises(fb.InputError, match=said):
        fb.montecarlo(where, fb.Draws(vary, **draws), **parts, **asked)


def test_stable_needs_gains(paper: fb.Plant) -> None:
    bare = fb.Plant(replace(paper.arm, gains=None))
    with pytest.raises(fb.InputError, match="closed_loop_abscissa: task gains needed"):
        fb.montecarlo(bare, {"stiffness": "normal(1,0.1)"}, criteria=["stable"])
