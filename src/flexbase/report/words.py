"""Words in pictures: units as formulas, numbers with a true minus."""

from __future__ import annotations

import re


def in_mathtext(unit: str) -> str:
    """A unit with its powers raised: m/(N s^2)."""
    return re.sub(r"\^(-?\w+)", r"$^{\1}$", unit)
