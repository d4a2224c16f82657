"""Fixtures that many tests share, and how hypothesis runs: reproducibly, without deadlines."""

from __future__ import annotations

import pytest
from hypothesis import settings

import flexbase
from flexbase import Plant, Pose
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
