"""Results as one JSON document: schema and program version first, undefined numbers as null."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

from flexbase import __version__
from flexbase.sheets.plain import plain

_FLAT = re.compile(r"\[\n\s+([^\[\]{}]*?)\n\s+\]")  # a list of numbers or words spread over lines


def document(command: str, content: Mapping[str, Any]) -> str:
    """The JSON document of a command, without a final newline; innermost lists stand on one line."""
    whole = {"schema": f"flexbase.{command}/1", "version": __version__, **content}
    text = json.dumps(plain(whole), indent=2, allow_nan=False)
    return _FLAT.sub(lambda found: "[" + re.sub(r",\n\s+", ", ", found[1]) + "]", text)
