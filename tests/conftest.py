"""Fixtures that many tests share; how hypothesis runs: reproducibly, without deadlines; what runs without extras."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from hypothesis import settings

import flexbase
from flexbase import MissingExtra, Plant, Pose
from systems.planar import PAPER_TIP

settings.register_profile("house", deadline=None, derandomize=True, database=None, max_examples=60)
settings.load_profile("house")


@pytest.fixture(scope="session")
def paper() -> Plant:
    """The paper's arm."""
    return flexbase.load("ueda2003")


@pytest.fixture(scope="session")
def paper_pose(paper: Plant) -> Pose:
    """The pose of theory §9."""
    return paper.at_tip(PAPER_TIP)


# `pytest --core` is for an installation without extras. Only there is a test left out that asks for one; what must run
# without them is in tests/core, and fails if it asks.
EXTRAS = {"casadi", "clarabel", "control", "cvxopt", "cvxpy", "dask", "distributed"}
EXTRAS |= {"jsonschema", "llvmlite", "mujoco", "pinocchio", "plotly", "zarr"}
ASKED: list[str] = []  # what the test that runs has asked for in vain, whoever caught the exception


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--core", action="store_true", help="without extras: leave out the tests that ask for one")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("core"):
        MissingExtra.__init__ = lambda self, *words: ASKED.append(*words)  # type: ignore[method-assign]


def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> pytest.Module | None:
    return CoreModule.from_parent(parent, path=module_path) if parent.config.getoption("core") else None


class CoreModule(pytest.Module):
    """A test file that is left out where it imports what is not installed, or asks for it meanwhile."""

    def collect(self) -> Iterable[pytest.Item | pytest.Collector]:
        with left_out(self):
            return super().collect()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item: pytest.Item) -> Generator[None, None, None]:
    with left_out(item):
        yield


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, None, None]:
    with left_out(item):
        yield


@contextmanager
def left_out(node: pytest.Item | pytest.Collector) -> Iterator[None]:
    """Skip what fails after it asked for an extra; only with --core, and nothing of tests/core."""
    ASKED.clear()
    try:
        yield
    except Exception as fault:
        package = getattr(fault.__cause__ or fault, "name", None) or ""
        asked = ASKED or package.partition(".")[0] in EXTRAS or "is not installed. Install it" in str(fault)
        if asked and node.config.getoption("core") and "core" not in node.path.parent.parts:
            pytest.skip(str(fault), allow_module_level=True)
        raise
