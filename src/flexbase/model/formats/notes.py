"""What was accepted but should be known, one line for each kind of thing, however many links and joints have it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from flexbase.model.formats.guard import listed


@dataclass(eq=False)
class Notes:
    """Remarks on named links, bodies and joints, in the order in which each kind was first made."""

    found: dict[tuple[str, str], list[str]] = field(default_factory=dict)

    def add(self, what: str, name: str, remark: str) -> None:
        """Remark on a named thing; `what` is the kind of thing: link, body, joint."""
        self.found.setdefault((what, remark), []).append(name)

    def lines(self, matters: Callable[[str, str], bool] = lambda what, name: True) -> list[str]:
        """A line for each remark, on those things that matter."""
        lines = []
        for (what, remark), names in self.found.items():
            kept = [name for name in names if matters(what, name)]
            if kept:
                lines.append(f"{what}{'s' * (len(kept) > 1)} {listed(kept)}: {remark}")
        return lines
