"""Every registered method says what its options are, where they are; whoever asks a person for them reads that."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import import_module
from inspect import Parameter, signature
from pkgutil import iter_modules
from typing import Any

import numpy as np
import pytest

import flexbase as fb
from flexbase.cli.options.from_request import from_methods

DESIGNS = [(fb.METHODS, name) for name in fb.METHODS]
CONTROLLERS = [(fb.HARDWARE_METHODS, name) for name in fb.HARDWARE_METHODS]
PYTHON_ONLY = {"E", "stages", "sensors"}  # no words of a command line: a matrix, stages, what is on unless taken away
ALL = pytest.mark.parametrize(
    ("registry", "name"), DESIGNS + CONTROLLERS, ids=lambda one: one if isinstance(one, str) else str(len(one))
)


@ALL
def test_every_option_says_what_it_is(registry: dict[str, Any], name: str) -> None:
    """All that is taken by keyword: a text, a kind that can be read from a word, and a default of that kind or None."""
    run = registry[name].run if registry is fb.METHODS else registry[name].make
    keywords = {one.name for one in signature(run).parameters.values() if one.kind is Parameter.KEYWORD_ONLY}
    said = {one.name: one for one in registry[name].options}
    assert keywords - {"loop"} - PYTHON_ONLY == set(said)
    assert ("loop" in keywords) == (registry is fb.METHODS)
    for one in said.values():
        assert one.text
        assert one.default is None or not one.choices or one.default in one.choices
    from_methods(None, {name: registry[name]})  # raises where no word can be read as an option


def called(pose: fb.Pose, registry: dict[str, Any], name: str, **options: Any) -> Any:
    ask = fb.design if registry is fb.METHODS else fb.make_controller
    return ask(pose, name, **options)


@ALL
def test_what_is_no_option_is_refused(paper_pose: fb.Pose, registry: dict[str, Any], name: str) -> None:
    with pytest.raises(fb.InputError, match=f'method {name}: the option "bogus" is unknown'):
        called(paper_pose, registry, name, bogus=1.0)


@ALL
def test_another_kind_of_value_is_refused(paper_pose: fb.Pose, registry: dict[str, Any], name: str) -> None:
    """A table in place of a number, a word or a list, for each option; a choice that is none."""
    for one in registry[name].options:
        with pytest.raises(fb.InputError, match=f"^{one.name}: {{'a': 1}} is not"):
            called(paper_pose, registry, name, **{one.name: {"a": 1}})
        if one.choices:
            with pytest.raises(fb.InputError, match=f'^{one.name}: "bogus" is unknown'):
                called(paper_pose, registry, name, **{one.name: "bogus"})


@ALL
def test_a_method_brings_its_own_compensator(paper_pose: fb.Pose, registry: dict[str, Any], name: str) -> None:
    with pytest.raises(fb.InputError, match="a compensator is given too, and a method brings its own"):
        called(paper_pose, registry, name, loop=fb.Loop(fb.Gain(np.zeros((2, 2)))))


def test_gains_of_a_loop_close_the_certificates_loop(paper_pose: fb.Pose) -> None:
    """E stays, the closed loop's figures are those of the gains given."""
    gains = fb.Gains(2e4 * np.eye(2), 4e2 * np.eye(2))
    own, given = fb.design(paper_pose), fb.design(paper_pose, loop=fb.Loop(gains=gains))
    assert np.array_equal(own.E, given.E)
    assert own.certificate.closed_loop_abscissa != given.certificate.closed_loop_abscissa


PROGRAM = """
import sys
from typing import Annotated
import numpy as np
from flexbase.compensators.judge.certificate import certify
from flexbase.compensators.registry import method
from flexbase.requests import Says
from flexbase.sampled.controller import pd_with_gain
from flexbase.synthesis.registry import hardware_method

@method("part-of-the-arm", "a throw-away method")
def part(pose, *, part: Annotated[float, Says("of the arm's own inertia", unit="1")] = 0.1, loop=None):
    return certify(pose, "part-of-the-arm", part * np.diag(np.diag(pose.M[1:, 1:])), loop=loop)

@hardware_method("damped", "a throw-away controller")
def damped(pose, sensing, gains, *, viscosity: Annotated[float, Says("of each joint", unit="N m s/rad")] = 1.0):
    made = pd_with_gain(pose, sensing, gains, None, "damped", viscosity * np.eye(2))
    made.notes["viscosity"] = viscosity
    return made

from flexbase.cli.main import run
sys.exit(run(sys.argv[1:]))
"""


def program(*words: str) -> str:
    done = subprocess.run([sys.executable, "-c", PROGRAM, *words], capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1), done.stderr
    return done.stdout


def test_a_new_method_brings_its_option_to_the_command_line(paper_pose: fb.Pose) -> None:
    """One function with one annotated option, registered before the program runs: in the help, and in the call."""
    shown = " ".join(program("design", "--help").replace("│", " ").split())
    assert "--part X" in shown
    assert "part-of-the-arm: of the arm's own inertia [1], 0.1" in shown
    for words, part in ((["--part", "0.05"], 0.05), ([], 0.1)):
        answer = program("design", "ueda2003", "--tip", "0.33,-0.25", "--method", "part-of-the-arm", *words, "--json")
        E = json.loads(answer)["E"]
        assert pytest.approx(part * np.diag(np.diag(paper_pose.M[1:, 1:]))) == np.array(E)


def test_a_new_controller_brings_its_option_to_the_command_line() -> None:
    shown = " ".join(program("simulate-sampled", "--help").replace("│", " ").split())
    assert "damped: of each joint [N m s/rad], 1" in shown
    move = (
        "simulate-sampled",
        "ueda2003",
        "--from",
        "0.33,-0.24",
        "--to",
        "0.33,-0.25",
        "--switch",
        "0.01",
        "--end",
        "0.02",
    )
    answers = [program(*move, "--method", "damped", *more, "--json") for more in ([], ["--viscosity", "30"])]
    assert answers[0] != answers[1]


@pytest.mark.parametrize("room", ["measures", "compensators.methods", "synthesis.methods"])
def test_a_file_in_the_room_is_enough(room: str) -> None:
    """Every file there has registered something, without a list of them anywhere."""
    files = {one.name for one in iter_modules(import_module(f"flexbase.{room}").__path__)} - {"registry"}
    registered = [*(one.run for one in (*fb.MEASURES.values(), *fb.METHODS.values()))]
    registered += [one.make for one in fb.HARDWARE_METHODS.values()]
    homes = {run.__module__.rpartition(".")[2] for run in registered if room in run.__module__}
    assert homes == files
