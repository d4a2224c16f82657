"""What runs in an installation without extras, and what is said there of the rest.

Where extras are installed they are hidden. `make test-core` runs this where they are not.
"""

from __future__ import annotations

import sys
from importlib.util import find_spec

import pytest

import flexbase as fb
from flexbase.cli.main import main
from flexbase.report.page.write import save_page

MAPS, FAST, ROBOTS = "maps", "fast", "robots"
EXTRAS = {"casadi", "clarabel", "control", "cvxpy", "distributed", "llvmlite", "mujoco", "pinocchio", "plotly", "zarr"}
INSTALLED = [name for name in EXTRAS if find_spec(name)]


@pytest.fixture(autouse=True)
def hidden(monkeypatch):
    """Packages, and what earlier tests have imported of them."""
    loaded = [name for name in sys.modules if name.partition(".")[0] in INSTALLED]
    for name in {*INSTALLED, "llvmlite.binding", *loaded}:
        monkeypatch.setitem(sys.modules, name, None)


@pytest.mark.parametrize(
    "ask",
    [
        lambda pose: fb.modes(pose)[0].frequency > 0.0,
        lambda pose: not fb.verdict(pose).positive_real,
        lambda pose: fb.verdict(pose, fb.design(pose, "exact", natural_frequency=346.8)).positive_real,
        lambda pose: fb.design(pose, "bounded", radius=0.6).E.any(),  # without the start that convex's gain gives
        lambda pose: fb.hardware_verdict(fb.make_controller(pose, "lqg")).stable,
        lambda pose: fb.simulate(pose.plant, (0.2, -0.3), pose, move=fb.Move(end=0.2)).stopped is None,
        lambda pose: (fb.sweep(pose.plant, cells=fb.Cells(shape=(9, 9))).status == 0).any(),
        lambda pose: fb.to_mjcf(pose.plant),
    ],
)
def test_it_runs(paper_pose, ask):
    assert ask(paper_pose)


def tiny(pose, **how):
    return fb.sweep(pose.plant, cells=fb.Cells(shape=(3, 3)), execution=fb.Execution(**how))


@pytest.mark.parametrize(
    ("package", "extra", "ask"),
    [
        ("pinocchio", ROBOTS, lambda pose, path: fb.load("ur5e-gantry")),
        ("llvmlite.binding", FAST, lambda pose, path: tiny(pose, engine="compiled")),
        ("llvmlite.binding", FAST, lambda pose, path: fb.simulate_many(pose.plant, pose.q[1:], pose)),
        ("llvmlite.binding", FAST, lambda pose, path: fb.robust_curves(pose.plant)),
        ("cvxpy", "convex", lambda pose, path: fb.design(pose, "convex", radius=0.2)),
        ("mujoco", "mujoco", lambda pose, path: fb.simulate(pose.plant, pose, pose, move=fb.Move(engine="mujoco"))),
        ("mujoco", "mujoco", lambda pose, path: fb.agreement(pose.plant, poses=1)),
        ("zarr", MAPS, lambda pose, path: tiny(pose, store=path / "map.zarr")),
        ("plotly.offline", MAPS, lambda pose, path: save_page(tiny(pose), path / "map.html")),
        ("control", "control", lambda pose, path: fb.linearise(pose).to_control()),
    ],
)
def test_a_missing_package_is_named_with_its_extra(paper_pose, tmp_path, package, extra, ask):
    with pytest.raises(fb.MissingExtra) as missing:
        ask(paper_pose, tmp_path)
    assert str(missing.value) == f'{package} is not installed. Install it with: pip install "flexbase[{extra}]"'


def test_the_command_line_says_so_too(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["check", "ur5e-gantry"])
    assert ended.value.code == 2
    assert 'pinocchio is not installed. Install it with: pip install "flexbase[robots]"' in capsys.readouterr().err
