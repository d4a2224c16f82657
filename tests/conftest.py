"""Fixtures that many tests share; how hypothesis runs: reproducibly, without deadlines; what runs without extras."""

from __future__ import annotations

from collections.abc import Generator, Iterable

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


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--core", action="store_true", help="without extras: leave out the tests that ask for one")


def pytest_pycollect_makemodule(module_path: object, parent: pytest.Collector) -> pytest.Module | None:
    return CoreModule.from_parent(parent, path=module_path) if parent.config.getoption("core") else None


class CoreModule(pytest.Module):
    """A test file that is left out where it imports what is not installed."""

    def collect(self) -> Iterable[pytest.Item | pytest.Collector]:
        try:
            return super().collect()
        except self.CollectError as fault:
            if _asks_for_an_extra(self, fault.__cause__):
                pytest.skip(str(fault.__cause__), allow_module_level=True)
            raise


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item: pytest.Item) -> Generator[None, None, None]:
    yield from _left_out(item)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, None, None]:
    yield from _left_out(item)


def _left_out(item: pytest.Item) -> Generator[None, None, None]:
    try:
        yield
    except (MissingExtra, ModuleNotFoundError) as fault:
        if item.config.getoption("core") and _asks_for_an_extra(item, fault):
            pytest.skip(str(fault))
        raise


def _asks_for_an_extra(node: pytest.Item | pytest.Collector, fault: BaseException | None) -> bool:
    foreign = isinstance(fault, ModuleNotFoundError) and (fault.name or "").partition(".")[0] in EXTRAS
    return (foreign or isinstance(fault, MissingExtra)) and "core" not in node.path.parent.parts
