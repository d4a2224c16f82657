"""The program as a whole: help, version, exit status, streams, start-up."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

import flexbase
from flexbase.cli import main as program
from flexbase.cli.commands import modes as modes_command
from flexbase.errors import MissingExtra
from flexbase.study.paper.table import PaperRow, Reproduction

from .conftest import TIP, Call

COMMANDS = list(program.COMMANDS)
FLEXBASE = [sys.executable, "-m", "flexbase"]


def test_version(call: Call) -> None:
    shown = call("--version")
    assert (shown.status, shown.out) == (0, f"flexbase {flexbase.__version__}\n")


@pytest.mark.parametrize("words", [("--help",), ("-h",), ()])
def test_help_lists_every_command(call: Call, words: tuple[str, ...]) -> None:
    shown = call(*words)
    assert shown.status == 0
    assert all(f"│ {command} " in shown.out for command in COMMANDS)
    assert {"check", "modes", "design", "simulate", "sweep", "draw", "reproduce", "robots", "init"} <= set(COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_an_example_and_fits(call: Call, command: str) -> None:
    shown = call(command, "--help")
    assert shown.status == 0
    assert f"\n  flexbase {command}" in shown.out
    assert max(map(len, shown.out.splitlines())) <= 80


LOOP = (
    "--stiffness --damping --rate --task-every --task-rate --compute-delay --task-delay --encoder-counts "
    "--acceleration --accelerometer-lag --acceleration-filter --acceleration-noise --task-noise "
    "--torque-limit --torque-slew"
)
SHOWN = {
    "modes": "--tip --joints --elbow --branch --compensator --out --json",
    "check": "--tip --joints --elbow --branch --json",
    "verdict": "--tip --joints --elbow --branch --compensator --bandwidth --out --json",
    "design": "--tip --joints --elbow --branch --method --natural-frequency --highest-frequency --objective --radius "
    f"--margin --lag --lag-share --derivatives --step --iterations --seed {LOOP} --out --json",
    "compare": f"--tip --joints --elbow --branch --method --methods {LOOP} --out --json",
    "safe-gain": f"--tip --joints --elbow --branch --method --methods {LOOP} --out --json",
    "region": f"--tip --joints --elbow --branch --method --compensator --half-width {LOOP} --out --json",
    "hardware-map": f"--method --compensator --shape --bounds --hold --elbow --branch {LOOP} "
    "--axes --resume --scheduler --workers --out --json",
    "hardware-path": f"--path --method --compensator --elbow --branch {LOOP} --workers --out --json",
    "simulate": "--from --to --elbow --branch --compensator --switch --end --trajectory --compensate --interval "
    "--self-motion --plant --stiffness --damping --out --json",
    "simulate-sampled": "--from --to --elbow --branch --compensator --switch --end --trajectory --plant --tolerance "
    f"--seed --method --disturb --free --softest --most --margin --scales --scale --order --noise {LOOP} --out --json",
    "manipulability": "--tip --joints --elbow --branch --compensator --convention --out --json",
    "sweep": "--over --shape --measure --measures --bounds --elbow --branch --hold --axes --vary --sampling --seed "
    "--engine --resume --scheduler --workers --compensator --difference --out --json",
    "montecarlo": "--tip --joints --elbow --branch --over --shape --bounds --axes --hold --vary --criterion --criteria "
    "--samples --seed --sampling --compensator --redesign --engine --scheduler --workers --out --json",
    "draw": "--before --at --out",
    "postures": "--tip --elbow --branch --measure --compensator --out --json",
    "robust-curves": "--axes --hold --compensator --out --json",
    "robust-points": "--modes --count --compensator --out --json",
    "layout": "--targets --measure --goal --along --turn --within --elbow --branch --compensator --out --json",
    "recommend": f"--tip --joints --elbow --branch {LOOP} --out --json",
    "hardware-study": "--poses --methods --seed --workers --out --json",
    "agreement": "--poses --trial --methods --seed --workers --out --json",
    "reproduce": "--out --json",
    "robots": "--json",
    "init": "--schema",
}


@pytest.mark.parametrize("command", COMMANDS)
def test_help_shows_every_option(call: Call, command: str) -> None:
    options = set(re.findall(r"--[a-z-]+", call(command, "--help").out.partition("Examples:")[0]))
    assert options == set(SHOWN[command].split())


def test_help_names_what_the_registries_hold(call: Call) -> None:
    assert all(name in call("design", "--help").out for name in flexbase.METHODS)
    assert all(name in call("sweep", "--help").out for name in flexbase.MEASURES)


@pytest.mark.parametrize("command", ["check", "modes", "verdict", "design", "manipulability", "robots"])
def test_examples_work(call: Call, command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every example line of the quick commands, in order, in one folder."""
    monkeypatch.chdir(tmp_path)
    assert call("init", "gantry.toml").status == 0
    made = call("design", "ueda2003", "--tip", TIP, "--out", "compensator.json")
    assert made.status == 0
    (tmp_path / "E.json").write_text((tmp_path / "compensator.json").read_text())
    lines = [line for line in call(command, "--help").out.splitlines() if line.startswith("  flexbase ")]
    assert lines
    for line in lines:
        assert call(*shlex.split(line)[1:]).status == 0, line


def test_missing_extra_is_exit_2(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    _raise(monkeypatch, MissingExtra("x is not installed"))
    outcome = call("modes", "ueda2003", "--tip", TIP)
    assert (outcome.status, outcome.out, outcome.err) == (2, "", "error: x is not installed\n")


def test_interrupt_is_exit_130(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    _raise(monkeypatch, KeyboardInterrupt())
    assert call("modes", "ueda2003", "--tip", TIP).status == 130


def test_fault_of_flexbase_itself_is_a_line_too(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    _raise(monkeypatch, ZeroDivisionError("by\nzero"))
    outcome = call("modes", "ueda2003", "--tip", TIP)
    assert outcome.status == 70
    assert outcome.err.startswith("error: flexbase failed: ZeroDivisionError: by zero.")
    assert len(outcome.err.splitlines()) == 1


def _raise(monkeypatch: pytest.MonkeyPatch, fault: BaseException) -> None:
    def fail(*_: object) -> None:
        raise fault

    monkeypatch.setattr(modes_command, "modes_of", fail)


def test_reproduce_shows_the_table(call: Call, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    asked = []

    def reproduce(folder: Path, progress: object) -> Reproduction:
        asked.append(folder)
        progress("drawing", 1, 2)  # type: ignore[operator]
        rows = PaperRow("w_1", -0.07, -0.0708, remark="read off"), PaperRow("omega_1", 300.0, 277.0, 0, "read off")
        return Reproduction((*rows, PaperRow("lost", None, float("nan"))))

    stub = ModuleType("flexbase.report.paper.all_figures")
    stub.reproduce = reproduce  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "flexbase.report.paper.all_figures", stub)
    shown = call("reproduce", "--out", tmp_path / "p")
    assert asked == [tmp_path / "p"]
    assert shown.status == 0
    assert "drawing" in shown.err
    assert all(word in shown.out for word in ("quantity", "paper", "ours", "difference", "-0.0708", "277"))
    assert shown.out.count("read off") == 1
    assert [row["ours"] for row in call("reproduce", "--json").document("reproduce")["rows"]] == [-0.0708, 277.0, None]


def test_as_a_process() -> None:
    found = subprocess.run([*FLEXBASE, "modes", "ueda2003", "--tip", "-0.3,0.2"], capture_output=True, text=True)
    assert (found.returncode, found.stderr) == (0, "")
    assert "332.455767" in found.stdout
    wrong = subprocess.run([*FLEXBASE, "modes", "ueda2003", "--tip", "9,9"], capture_output=True, text=True)
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert wrong.stderr.startswith("error: --tip: ")


def test_closed_pipe_is_quiet() -> None:
    """The reader is gone before anything is written."""
    process = subprocess.Popen(
        [*FLEXBASE, "modes", "ueda2003", "--tip", TIP], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()
    said = process.stderr.read()
    process.stderr.close()
    assert said == ""
    assert process.wait() == 141


FULL = Path("/dev/full")


@pytest.mark.skipif(not FULL.exists(), reason="needs the device that is always full")
@pytest.mark.parametrize("words", [["robots"], ["modes", "ueda2003", "--tip", TIP, "--json"], ["--help"]])
def test_a_full_disk_is_exit_74(words: list[str]) -> None:
    """One line that says so: no traceback, nothing from the interpreter as it leaves."""
    with FULL.open("w") as full:
        found = subprocess.run([*FLEXBASE, *words], stdout=full, stderr=subprocess.PIPE, text=True)
    assert found.returncode == 74
    assert found.stderr.startswith("error: standard output cannot be written (No space left on device). ")
    assert len(found.stderr.splitlines()) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="needs a POSIX shell")
def test_closed_streams_are_exit_74() -> None:
    command = shlex.join([*FLEXBASE, "robots"])
    found = subprocess.run(["sh", "-c", f"{command} >&-"], capture_output=True, text=True)
    assert (found.returncode, found.stdout) == (74, "")
    assert found.stderr == "error: standard output cannot be written (it is closed). Make room, or send it elsewhere.\n"
    assert subprocess.run(["sh", "-c", f"{command} >&- 2>&-"], capture_output=True).returncode == 74


def test_narrow_encoding_is_no_fault() -> None:
    found = subprocess.run(
        [*FLEXBASE, "modes", "ueda2003", "--tip", TIP], capture_output=True, env={"PYTHONIOENCODING": "ascii"}
    )
    assert (found.returncode, found.stderr) == (0, b"")


@pytest.mark.parametrize("words", [["--help"], ["modes", "ueda2003", "--tip", TIP]])
def test_starts_without_heavy_packages(words: list[str]) -> None:
    code = (
        "import sys; from flexbase.cli.main import run; run(sys.argv[1:]); "
        "print([name for name in ('matplotlib', 'control', 'casadi', 'xarray') if name in sys.modules])"
    )
    found = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=True)
    assert found.stdout.splitlines()[-1] == "[]"


def test_every_file_of_the_command_line_is_short() -> None:
    files = sorted(Path(program.__file__).parent.glob("*.py"))
    assert {file.name: n for file in files if (n := len(file.read_text().splitlines())) > 80} == {}
