"""Docstrings of this project are plain text; here they become reStructuredText.

`name` becomes code, a line "name : meaning" an entry of a list, and no other character has a meaning of its own.
"""

import re
from typing import Any

from sphinx.application import Sphinx

ARRAY = re.compile(r"~?numpy\.ndarray\[tuple\[~?typing\.Any, \.\.\.\], ~?numpy\.dtype\[~?numpy\.\w+\]\]")
MODULE = re.compile(r"~?\b(?:flexbase|numpy|pathlib|typing|collections)\.(?:\w+\.)*|~")
ENTRY = re.compile(r"^(\w[\w', ]{0,60}) : (.+)$")


def _escaped(text: str) -> str:
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(
        f"``{part[1:-1]}``" if part.startswith("`") else re.sub(r"([\\*|_`])", r"\\\1", part) for part in parts
    )


def _convert(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    converted, in_list = [], False
    for line in lines:
        entry = ENTRY.match(line)
        if entry:
            if not in_list:
                converted.append("")
            names, meaning = entry.groups()
            converted.append(f"* {', '.join(f'``{part.strip()}``' for part in names.split(','))}: {_escaped(meaning)}")
            in_list = True
        elif in_list and line.startswith("    "):
            converted.append("  " + _escaped(line.strip()))
        else:
            if in_list and line.strip():
                converted.append("")
            in_list = in_list and not line.strip()
            converted.append(_escaped(line))
    lines[:] = converted


def _shorten(app: Sphinx, what: str, name: str, obj: Any, options: Any, signature: str, returns: str) -> Any:
    """Write arrays as Array, since the docstrings say their shapes, and types without their modules."""
    return tuple(text and MODULE.sub("", ARRAY.sub("Array", text)) for text in (signature, returns))


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", _convert)
    app.connect("autodoc-process-signature", _shorten)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
