"""Results as one JSON document: schema and program version first, undefined numbers as null."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from typing import Any

from flexbase import __version__

_FLAT = re.compile(r"\[\n\s+([^\[\]{}]*?)\n\s+\]")  # a list of numbers or words spread over lines


def document(command: str, content: Mapping[str, Any]) -> str:
    """The JSON document of a command, without a final newline; innermost lists stand on one line."""
    whole = {"schema": f"flexbase.{command}/1", "version": __version__, **_with_null(content)}
    text = json.dumps(whole, indent=2, allow_nan=False)
    return _FLAT.sub(lambda found: "[" + re.sub(r",\n\s+", ", ", found[1]) + "]", text)


def _with_null(value: Any) -> Any:
    """The same, with None for what is not a finite number."""
    if isinstance(value, Mapping):
        return {str(key): _with_null(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_with_null(entry) for entry in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value
