"""Every numbered example runs from the checkout, without a display and without a warning."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))
SLOW = {"03_simulate", "05_own_machine", "06_ur5e", "07_postures", "09_recommend"}  # 5 to 30 s each


def test_there_are_examples():
    assert len(EXAMPLES) >= 4


def marked(path):
    return pytest.param(path, id=path.stem, marks=[pytest.mark.slow] * (path.stem in SLOW))


@pytest.mark.parametrize("example", [marked(path) for path in EXAMPLES])
def test_example(example, tmp_path):
    """It ends well and prints something; files go below the folder it runs in."""
    environment = {**os.environ, "MPLBACKEND": "Agg"}
    run = subprocess.run([sys.executable, example], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert run.stdout.strip()
