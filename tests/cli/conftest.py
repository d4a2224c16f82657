"""A command line run in this process, and a compensator file made by one."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from flexbase.cli.main import main, run

TIP = "0.33,-0.25"


class Outcome(NamedTuple):
    status: int
    out: str
    err: str

    def document(self, command: str) -> dict[str, Any]:
        """The one JSON document on stdout: strict JSON, of this command and version."""
        import flexbase

        def refuse(word: str) -> None:
            raise AssertionError(f"{word} in JSON")

        found = json.loads(self.out, parse_constant=refuse)
        assert found.pop("schema") == f"flexbase.{command}/1"
        assert found.pop("version") == flexbase.__version__
        return dict(found)


Call = Callable[..., Outcome]


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Call:
    """`call("modes", "ueda2003", ...)` -> status, stdout, stderr; at 80 columns."""
    monkeypatch.setenv("COLUMNS", "80")

    def call(*arguments: str | Path) -> Outcome:
        with pytest.raises(SystemExit) as left:
            main([str(word) for word in arguments])
        status = left.value.code
        assert isinstance(status, int)
        return Outcome(status, *capsys.readouterr())

    return call


@pytest.fixture(scope="session")
def compensator_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The exact design of theory §9, as `design --out` writes it."""
    path = tmp_path_factory.mktemp("compensator") / "E.json"
    asked = ["design", "ueda2003", "--tip", TIP, "--natural-frequency", "346.8", "--out", str(path), "--json"]
    assert run(asked) == 0
    return path
