"""One door: whatever verb is given a wrong compensator, wrong gains, a wrong sensing or no pose says the same."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import flexbase as fb
from flexbase.cli.main import run
from flexbase.model.loop import loop_on

TIP, START = [0.33, -0.25], [0.33, 0.25]
NAN, INF = float("nan"), float("inf")

E = {  # of an arm with two joints
    "one row": [[0.1]],
    "three rows": np.zeros((3, 3)),
    "a vector": [0.1, 0.2],
    "a number": 0.1,
    "not square": np.zeros((2, 3)),
    "a stack": np.zeros((1, 2, 2)),
    "empty": [],
    "rows of two lengths": [[0.1, 0.0], [0.0]],
    "not symmetric": [[0.1, 0.05], [0.0, 0.1]],
    "NaN": [[NAN, 0.0], [0.0, 0.1]],
    "infinite": [[INF, 0.0], [0.0, 0.1]],
    "minus infinite": [[-INF, 0.0], [0.0, 0.1]],
    "complex": np.array([[0.1j, 0.0], [0.0, 0.1]]),
    "words": [["a", "b"], ["c", "d"]],
    "numbers as words": [["0.1", "0"], ["0", "0.1"]],
    "truths": [[True, False], [False, True]],
    "None": None,
    "a word": "E.json",
    "a table": {"a": 1},
}
GAINS = {
    "three rows": (np.eye(3), np.eye(3)),
    "one number": ([1e5], [1e3, 1e3]),
    "not symmetric": ([[1e5, 1e3], [0.0, 1e5]], [1e3, 1e3]),
    "NaN": ([NAN, 1e5], [1e3, 1e3]),
    "infinite": ([1e5, 1e5], [INF, 1e3]),
    "negative": ([-1e5, 1e5], [1e3, 1e3]),
    "negative damping": ([1e5, 1e5], [1e3, -1e3]),
    "indefinite": ([[1e5, 2e5], [2e5, 1e5]], [1e3, 1e3]),
    "complex": (np.array([1e5j, 1e5]), [1e3, 1e3]),
    "words": (["stiff", "soft"], [1e3, 1e3]),
    "empty": ([], []),
}
SENSING = {
    "no rate": {"rate": 0.0},
    "negative rate": {"rate": -1000.0},
    "NaN": {"rate": NAN},
    "infinite": {"rate": INF},
    "a word": {"rate": "fast"},
    "a truth": {"rate": True},
    "in kHz and part of a sample": {"compute_delay": 0.5},
    "a delay that is negative": {"task_delay": -1},
    "a delay without end": {"compute_delay": 10**9},
    "never": {"task_every": 0},
    "an unknown sense": {"acceleration": "gyro"},
    "a filter beyond the rate": {"acceleration": "encoders", "acceleration_filter": 900.0},
    "negative noise": {"task_noise": -1.0},
    "no counts": {"encoder_counts": 0.0},
    "limits of another arm": {"torque_limit": (1.0, 1.0, 1.0)},
    "a limit of nothing": {"torque_slew": (0.0, 1.0)},
}


def bad_loops() -> dict[str, fb.Loop]:
    """Every bad input as the loop that carries it."""
    compensators = {f"E, {name}": fb.Loop(fb.Gain(value)) for name, value in E.items()}
    gains = {f"gains, {name}": fb.Loop(gains=fb.Gains(*pair)) for name, pair in GAINS.items()}
    sensing = {f"sensing, {name}": fb.Loop(sensing=fb.Sensing(**given)) for name, given in SENSING.items()}
    others = {
        "a compensator that is a word": fb.Loop("E.json"),
        "gains that are a number": fb.Loop(gains=1e5),
        "a sensing that is a rate": fb.Loop(sensing=1000.0),
    }
    return {**compensators, **gains, **sensing, **others}


def one_case(pose: fb.Pose, loop: Any) -> Any:
    return fb.simulate(pose.plant, pose.plant.at_tip(START), pose, loop)


VERBS: dict[str, Callable[[fb.Pose, Any], Any]] = {
    "modes": fb.modes,
    "verdict": fb.verdict,
    "linearise": fb.linearise,
    "design": lambda pose, loop: fb.design(pose, loop=loop),
    "manipulability": fb.manipulability,
    "simulate": one_case,
    "simulate_many": lambda pose, loop: fb.simulate_many(pose.plant, pose, pose, loop),
    "sweep": lambda pose, loop: fb.sweep(pose.plant, loop=loop, cells=fb.Cells(shape=(3, 3))),
    "montecarlo": lambda pose, loop: fb.montecarlo(pose, fb.Draws({"payload": 1.0}, samples=2), loop=loop),
    "postures": lambda pose, loop: fb.postures(pose.plant, TIP, loop=loop),
    "layout": lambda pose, loop: fb.layout(pose.plant, [TIP], loop=loop),
    "robust_curves": lambda pose, loop: fb.robust_curves(pose.plant, loop=loop),
    "robust_points": lambda pose, loop: fb.robust_points(pose.plant, loop=loop),
    "make_controller": lambda pose, loop: fb.make_controller(pose, loop=loop),
    "compare": lambda pose, loop: fb.compare(pose, ["none"], loop),
    "recommend": lambda pose, loop: fb.recommend(pose, loop=loop, methods=["none"]),
    "safe_gain": lambda pose, loop: fb.safe_gain(pose, "none", loop),
    "region": lambda pose, loop: fb.region(pose, "none", loop),
    "as_it_runs": fb.as_it_runs,
    "hardware_map": lambda pose, loop: fb.hardware_map(
        pose.plant, loop=loop, cells=fb.Cells(shape=(2, 2)), execution=fb.Execution(workers=1)
    ),
    "hardware_path": lambda pose, loop: fb.hardware_path(pose.plant, [TIP], loop=loop, workers=1),
    "hardware_study": lambda pose, loop: fb.hardware_study(pose.plant, poses=1, methods=["none"], loop=loop, workers=1),
}


def refusal(call: Callable[[], Any]) -> str:
    with pytest.raises(fb.InputError) as caught:
        call()
    assert type(caught.value) is fb.InputError
    return str(caught.value)


def test_there_are_forty_and_the_door_refuses_each(paper: fb.Plant) -> None:
    """At least forty bad inputs, each refused by a sentence of its own kind that names the thing and a mend."""
    loops = bad_loops()
    assert len(loops) >= 40
    for name, loop in loops.items():
        said = refusal(lambda loop=loop: loop_on(paper.arm, loop))
        assert said.startswith(("compensator", "gains", "sensing")), (name, said)
        assert said.count(". ") or said.endswith("."), (name, said)


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_refuses_as_the_door_does(paper_pose: fb.Pose, verb: str) -> None:
    """The same sentence, letter by letter, whatever is asked for, before anything is computed."""
    for name, loop in bad_loops().items():
        expected = refusal(lambda loop=loop: loop_on(paper_pose.arm, loop))
        assert refusal(lambda loop=loop: VERBS[verb](paper_pose, loop)) == expected, name


LAWS = (
    "simulate",
    "make_controller",
    "compare",
    "recommend",
    "safe_gain",
    "region",
    "hardware_map",
    "hardware_path",
    "hardware_study",
)


@pytest.mark.parametrize("verb", LAWS)
def test_without_task_gains_the_sentence_is_the_same(verb: str) -> None:
    """Where a law needs gains and neither project nor caller has any."""
    from dataclasses import replace

    plant = fb.load("ueda2003")
    bare = fb.Plant(replace(plant.arm, gains=None)).at_tip(TIP)
    expected = refusal(lambda: loop_on(bare.arm).gains)
    assert "no task gains" in expected
    assert refusal(lambda: VERBS[verb](bare, None)) == expected


POSES: dict[str, Any] = {"None": None, "a word": "here", "a tip": TIP, "an array": np.array(TIP), "a number": 1.0}
AT_A_POSE: dict[str, Callable[[Any], Any]] = {
    "modes": fb.modes,
    "verdict": fb.verdict,
    "design": fb.design,
    "manipulability": fb.manipulability,
    "linearise": fb.linearise,
    "make_controller": fb.make_controller,
    "compare": fb.compare,
    "recommend": fb.recommend,
    "safe_gain": fb.safe_gain,
    "region": lambda pose: fb.region(pose, "none"),
    "as_it_runs": lambda pose: fb.as_it_runs(pose, None),
}


@pytest.mark.parametrize("verb", AT_A_POSE)
@pytest.mark.parametrize("given", [*POSES, "a plant"])
def test_what_is_no_pose(paper: fb.Plant, verb: str, given: str) -> None:
    value = paper if given == "a plant" else POSES[given]
    said = refusal(lambda: AT_A_POSE[verb](value))
    assert said.startswith(f"pose: {type(value).__name__} given. Make one with plant.at(joints)")


ON_A_PLANT: dict[str, Callable[[Any], Any]] = {
    "simulate": lambda plant: fb.simulate(plant, START, TIP),
    "simulate_many": lambda plant: fb.simulate_many(plant, TIP, TIP),
    "sweep": fb.sweep,
    "montecarlo": lambda plant: fb.montecarlo(plant, {"payload": 1.0}),
    "postures": lambda plant: fb.postures(plant, TIP),
    "layout": lambda plant: fb.layout(plant, [TIP]),
    "robust_curves": fb.robust_curves,
    "robust_points": fb.robust_points,
    "hardware_map": fb.hardware_map,
    "hardware_path": lambda plant: fb.hardware_path(plant, [TIP]),
    "hardware_study": fb.hardware_study,
    "agreement": fb.agreement,
}


@pytest.mark.parametrize("verb", ON_A_PLANT)
def test_what_is_no_plant(verb: str) -> None:
    """A name in place of what `load` returns."""
    assert refusal(lambda: ON_A_PLANT[verb]("ueda2003")).startswith("plant: str given. Make one with flexbase.load")


AT = ["--tip", "0.33,-0.25"]
PATH = Path(__file__).parent / "tips.csv"
WITH_A_FILE = {
    "modes": ["modes", "ueda2003", *AT],
    "verdict": ["verdict", "ueda2003", *AT],
    "manipulability": ["manipulability", "ueda2003", *AT],
    "sweep": ["sweep", "ueda2003", "--shape", "3,3"],
    "montecarlo": ["montecarlo", "ueda2003", *AT, "--vary", "payload=fixed:1"],
    "posture": ["postures", "ueda2003", *AT],
    "robust-curves": ["robust-curves", "ueda2003"],
    "robust-points": ["robust-points", "ueda2003"],
    "simulate": ["simulate", "ueda2003", "--from", "0.33,0.25", "--to", "0.33,-0.25"],
    "hardware-map": ["hardware-map", "ueda2003", "--shape", "2,2"],
    "hardware-path": ["hardware-path", "ueda2003", "--path", str(PATH)],
    "region": ["region", "ueda2003", *AT],
    "simulate-sampled": ["simulate-sampled", "ueda2003", "--from", "0.33,0.25", "--to", "0.33,-0.25"],
}
WITH_A_LOOP = {
    "compare": ["compare", "ueda2003", *AT, "--method", "none"],
    "safe-gain": ["safe-gain", "ueda2003", *AT],
    "region": ["region", "ueda2003", *AT],
    "hardware-path": ["hardware-path", "ueda2003", "--path", str(PATH)],
    "recommend": ["recommend", "ueda2003", *AT],
    "design": ["design", "ueda2003", *AT],
    "hardware-map": ["hardware-map", "ueda2003", "--shape", "2,2"],
    "simulate-sampled": ["simulate-sampled", "ueda2003", "--from", "0.33,0.25", "--to", "0.33,-0.25"],
}
OPTIONS = {
    "negative gains": ["--stiffness=-1e5,1e5"],
    "gains of three rows": ["--stiffness", "1e5,1e5,1e5"],
    "gains in words": ["--damping", "soft,hard"],
    "infinite gains": ["--damping", "inf,1"],
    "no gains": ["--stiffness", ""],
    "no rate": ["--rate", "0"],
    "a rate in words": ["--rate", "fast"],
    "a delay that is negative": ["--compute-delay=-1"],
    "an unknown sense": ["--acceleration", "gyro"],
    "limits of another arm": ["--torque-limit", "1,1,1"],
}


def line(capsys: pytest.CaptureFixture[str], words: list[str]) -> str:
    """What the program says in its one line of error; its status is 2 and it prints nothing else."""
    assert run(words) == 2, words
    out, err = capsys.readouterr()
    assert out == ""
    errors = [text for text in err.splitlines() if text.startswith("error: ")]
    assert len(errors) == 1, err
    return errors[0]


WRITABLE = [name for name, value in E.items() if not isinstance(value, np.ndarray) or value.dtype.kind == "f"]


@pytest.mark.parametrize("name", WRITABLE)
def test_every_command_refuses_a_file_alike(
    paper_pose: fb.Pose, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    """A compensator file with a bad E: the same line from every command."""
    path = tmp_path / "E.json"
    fb.design(paper_pose).save(path)
    value = E[name].tolist() if isinstance(E[name], np.ndarray) else E[name]
    path.write_text(json.dumps({**json.loads(path.read_text()), "E": value}))
    said = {command: line(capsys, [*words, "--compensator", str(path)]) for command, words in WITH_A_FILE.items()}
    assert len(set(said.values())) == 1, said
    assert next(iter(said.values())).startswith("error: --compensator: ")


@pytest.mark.parametrize("name", OPTIONS)
def test_every_command_refuses_options_alike(capsys: pytest.CaptureFixture[str], name: str) -> None:
    """The same line from every command that has the option."""
    said = {command: line(capsys, [*words, *OPTIONS[name]]) for command, words in WITH_A_LOOP.items()}
    assert len(set(said.values())) == 1, said
    assert OPTIONS[name][0].partition("=")[0] in next(iter(said.values()))
