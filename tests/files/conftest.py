"""The robot files of these tests, and how a changed one is read."""

from __future__ import annotations

from pathlib import Path

import pytest

from flexbase.errors import InputError
from flexbase.model.formats.robot import RobotFile, read_robot_file

DATA = Path(__file__).parent / "data"


class Changed:
    """Reads robot files after replacing some of their text."""

    error = InputError

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def read(self, name: str, *changes: tuple[str, str], tool: str | None = "tool") -> RobotFile:
        text = (DATA / name).read_text()
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new)
        (self.folder / name).write_text(text)
        return read_robot_file(self.folder / name, tool, folder=self.folder)

    def refused(self, name: str, *changes: tuple[str, str], tool: str | None = "tool") -> str:
        with pytest.raises(InputError) as caught:
            self.read(name, *changes, tool=tool)
        return str(caught.value)


@pytest.fixture
def changed(tmp_path: Path) -> Changed:
    """Robot files with changes."""
    return Changed(tmp_path)
