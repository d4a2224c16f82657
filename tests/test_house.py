"""Rules of the house that a machine can hold: file sizes, extras named in errors, nothing heavy imported early."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import flexbase as fb
from flexbase.errors import MissingExtra, import_extra

SOURCE = Path(fb.__file__).parent


def test_no_file_is_longer_than_400_lines():
    sizes = {path.relative_to(SOURCE): len(path.read_text("utf-8").splitlines()) for path in SOURCE.rglob("*.py")}
    assert len(sizes) > 40
    assert {path: lines for path, lines in sizes.items() if lines > 400} == {}


def test_a_missing_package_is_named_with_its_extra():
    with pytest.raises(MissingExtra, match=r'no_such_package is not installed.*"flexbase\[maps\]"'):
        import_extra("no_such_package", "maps")


def test_importing_flexbase_stays_light():
    """matplotlib, control, xarray and scipy.stats each cost most of a second: they load when they are used."""
    program = (
        "import sys, flexbase; names = {name.partition('.')[0] for name in sys.modules};"
        "print(*sorted(names), 'scipy.stats' in sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    loaded = run.stdout.split()
    assert "numpy" in loaded  # the list is real
    assert not {"matplotlib", "control", "xarray", "casadi", "pinocchio", "mujoco", "cvxpy"} & set(loaded)
    assert loaded[-1] == "False"


def test_every_public_name_is_documented():
    undocumented = [
        name
        for name in fb.__all__
        if name not in ("__version__", "METHODS", "MEASURES") and not (getattr(fb, name).__doc__ or "").strip()
    ]
    assert undocumented == []
