"""The public face: a command, its function, what it answers and its document have one name."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_type_hints

import pytest
import xarray

import flexbase as fb
from flexbase import RENAMED
from flexbase.cli.catalogue import COMMANDS
from flexbase.cli.catalogue import RENAMED as RENAMED_COMMANDS

HOME = Path(__file__).parents[2]
CHANGELOG, API, PAGE = (
    (HOME / name).read_text("utf-8") for name in ("CHANGELOG.md", "docs/api.md", "docs/command-line.md")
)
ANSWERS = {
    "check": fb.Check,
    "modes": fb.Modes,
    "verdict": fb.Verdict,
    "manipulability": fb.Manipulability,
    "design": fb.Compensator,
    "simulate": fb.Run,
    "recommend": fb.Recommendation,
    "compare": fb.Comparison,
    "safe-gain": fb.SafeGain,
    "region": fb.Region,
    "simulate-sampled": fb.SampledRun,
    "sweep": xarray.Dataset,
    "hardware-map": xarray.Dataset,
    "hardware-path": fb.HardwarePath,
    "draw": xarray.Dataset,
    "montecarlo": fb.MonteCarlo,
    "postures": fb.Postures,
    "robust-curves": fb.RobustCurves,
    "robust-points": fb.RobustPoints,
    "layout": fb.Layout,
    "hardware-study": fb.HardwareStudy,
    "agreement": fb.Agreement,
    "reproduce": fb.Reproduction,
    "robots": fb.Robots,
    "init": Path,
}


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_is_a_function_and_its_answer_is_public(command: str) -> None:
    function = getattr(fb, command.replace("-", "_"))
    assert function.__name__ in fb.__all__
    answer = get_type_hints(function, None, {"xarray": xarray})["return"]
    assert answer is ANSWERS[command]
    assert answer.__module__.partition(".")[0] != "flexbase" or answer.__name__ in fb.__all__


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_has_its_place_in_the_docs(command: str) -> None:
    headings = re.findall(r"^## (.*)$", PAGE, re.M)
    assert command in ", ".join(headings).split(", ")


@pytest.mark.parametrize("command", COMMANDS)
def test_a_document_says_which_command_made_it(command: str) -> None:
    """The name that a command gives to its document is the one by which it is called."""
    if command in ("init", "draw"):  # write files, no document
        return
    source = (HOME / f"src/flexbase/cli/commands/{command.replace('-', '_')}.py").read_text("utf-8")
    assert set(re.findall(r'\b(?:show|say|show_map|document|write_out)\((?:out, )?"([a-z-]+)"', source)) == {command}


def test_all_is_there_and_stands_in_no_rooms_way() -> None:
    rooms = {path.stem for path in (HOME / "src/flexbase").iterdir()}
    for name in fb.__all__:
        assert hasattr(fb, name), name
    assert not rooms & set(fb.__all__)
    assert sorted(fb.__all__) == fb.__all__


@pytest.mark.parametrize("name", RENAMED)
def test_a_name_of_before_says_its_new_one(name: str) -> None:
    with pytest.raises(AttributeError, match=f"now called {RENAMED[name]}"):
        getattr(fb, name)
    assert hasattr(fb, RENAMED[name])
    assert re.search(rf"^\|.*`(fb\.)?{name}`.*\|.*`(fb\.)?{RENAMED[name]}`.*\|$", CHANGELOG, re.M)


@pytest.mark.parametrize("name", RENAMED_COMMANDS)
def test_a_command_of_before_says_its_new_one(name: str) -> None:
    assert name not in COMMANDS
    row = re.search(rf"^\| commands? `{name}[` ].*\|(.*)\|$", CHANGELOG, re.M)
    assert row
    named = re.findall(r"[a-z]+(?:-[a-z]+)*", RENAMED_COMMANDS[name])
    assert set(named) & set(COMMANDS) == set(re.findall(r"`([a-z-]+)`", row[1]))


@pytest.mark.parametrize("path", [*HOME.glob("examples/*.py"), HOME / "README.md", *HOME.glob("docs/*.md")], ids=str)
def test_what_people_read_imports_the_face_alone(path: Path) -> None:
    assert not re.search(r"^\s*(from flexbase\.|import flexbase\.)", path.read_text("utf-8"), re.M)


def test_the_promise_stands_in_the_docs() -> None:
    assert "**Stability.**" in API
    assert "flexbase.__all__" in API
