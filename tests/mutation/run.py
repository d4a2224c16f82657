"""Does a test fail for every wrong program? `python tests/mutation/run.py [MODULE ...]`, or `make mutation`.

Each mutant of the modules in `targets.toml` is loaded in place of its module, in a process of its own, and the tests
beside it there are run until one fails. No file is changed. A mutant that passes them all is a survivor: a test is
missing, or it is no other program, and `equivalent.toml` says why.
"""

from __future__ import annotations

import importlib
import importlib.abc
import importlib.machinery
import os
import signal
import sys
import time
import tomllib
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "src"), str(ROOT / "tests")]
from mutation.mutants import Mutant, mutants_of  # noqa: E402

SLOWER = 10.0  # times as long as the tests take on the right program is a loop without end
HEAVY = "numpy scipy.linalg scipy.optimize scipy.signal scipy.stats pydantic xarray cyclopts rich.console"
HEAVY += " casadi llvmlite.binding pinocchio mujoco jsonschema cvxpy matplotlib.figure"


def main(wanted: Iterable[str]) -> int:
    """Run, and print the survivors. Returns 1 where there is one that is not known to be equivalent."""
    targets = tomllib.loads((HERE / "targets.toml").read_text("utf-8"))
    known = tomllib.loads((HERE / "equivalent.toml").read_text("utf-8"))
    for name in HEAVY.split():
        importlib.import_module(name)  # shared by all processes
    tally = {"mutants": 0, "killed": 0, "equivalent": 0, "survived": 0}
    unknown = set(wanted) - set(targets)
    if unknown:
        sys.exit(f"not in targets.toml: {', '.join(sorted(unknown))}")
    for module in list(wanted) or targets:
        tests = [str(ROOT / "tests" / one) for one in targets[module]]
        reasons = known.get(module, {})
        begin = time.monotonic()
        if not _passes(module, None, tests, 3600.0):
            sys.exit(f"{module}: its tests fail without any mutant: {' '.join(targets[module])}")
        longest = SLOWER * (time.monotonic() - begin) + 10.0
        source = (ROOT / "src" / Path(*module.split("."))).with_suffix(".py").read_text("utf-8")
        for mutant in mutants_of(source):
            fate = "survived" if _passes(module, mutant, tests, longest) else "killed"
            if fate == "survived" and mutant.name in reasons:
                fate = "equivalent"
            tally["mutants"] += 1
            tally[fate] += 1
            if fate == "survived":
                print(f"{module}:{mutant.line}: {mutant.name}", flush=True)
        print(f"# {module}: " + ", ".join(f"{count} {fate}" for fate, count in tally.items()) + " so far", flush=True)
    return int(tally["survived"] > 0)


def _passes(module: str, mutant: Mutant | None, tests: list[str], longest: float) -> bool:
    """Whether all tests pass with the mutant, in a process of its own."""
    child = os.fork()
    if child == 0:
        signal.alarm(int(longest) + 1)
        if mutant is not None:
            sys.meta_path.insert(0, Instead(module, mutant))
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, 1)
            os.dup2(nowhere, 2)
        os.chdir(ROOT)
        os._exit(int(pytest.main(["-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-m", "not slow", *tests])))
    return os.waitpid(child, 0)[1] == 0


class Instead(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Gives a mutant where its module is imported."""

    def __init__(self, module: str, mutant: Mutant) -> None:
        self.module, self.mutant = module, mutant
        self.path = (ROOT / "src" / Path(*module.split("."))).with_suffix(".py")

    def find_spec(self, name: str, path: object = None, target: object = None) -> importlib.machinery.ModuleSpec | None:
        if name != self.module:
            return None
        return importlib.machinery.ModuleSpec(name, self, origin=str(self.path))

    def exec_module(self, module: ModuleType) -> None:
        module.__file__ = str(self.path)
        exec(compile(self.mutant.tree, str(self.path), "exec"), module.__dict__)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
