"""Results as plain numbers: what a JSON document holds."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np


class Plain:
    """A dataclass that gives itself as plain numbers.

    document : its keys, in order; all fields if there are none. "key=path" takes the value from elsewhere, such as
        "q=pose.q", through attributes and methods without arguments; "*path" adds the entries of a mapping
    """

    document: ClassVar[tuple[str, ...]] = ()

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, words and lists, with units in the names; None for what is undefined or infinite."""
        assert dataclasses.is_dataclass(self)
        found: dict[str, Any] = {}
        for entry in self.document or tuple(one.name for one in dataclasses.fields(self)):
            key, _, path = entry.partition("=")
            value = plain(_at(self, (path or key).lstrip("*")))
            found |= value if key.startswith("*") else {key: value}
        return found


def plain(value: Any) -> Any:
    """Plain numbers, words, lists and mappings of them; None for what is undefined or infinite."""
    if isinstance(value, Plain):
        return value.to_dict()
    if isinstance(value, np.ndarray):
        return value.tolist() if value.dtype.kind in "iubU" or np.isfinite(value).all() else plain(value.tolist())
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if hasattr(value, "_asdict"):  # a named tuple
        return plain(value._asdict())
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if dataclasses.is_dataclass(value):
        return {one.name: plain(getattr(value, one.name)) for one in dataclasses.fields(value)}
    return value


def _at(value: Any, path: str) -> Any:
    """The value at the end of a path; None where something on the way is."""
    for name in path.split("."):
        if value is not None:
            value = getattr(value, name)
            value = value() if callable(value) else value
    return value
