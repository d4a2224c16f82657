"""Units of joint and task quantities, from the units of their coordinates (m or rad)."""

from __future__ import annotations

from collections.abc import Iterable

_UNITS = {  # quantity -> unit over metres, unit over radians
    "stiffness": ("N/m", "N m/rad"),
    "damping": ("N s/m", "N m s/rad"),
    "effort": ("N", "N m"),
    "speed": ("m/s", "rad/s"),
    "inertia": ("kg", "kg m^2"),
}


def each(quantity: str, coordinates: Iterable[str]) -> list[str]:
    """The unit of a quantity along each coordinate."""
    metres, radians = _UNITS[quantity]
    return [radians if unit == "rad" else metres for unit in coordinates]


def common(quantity: str, coordinates: Iterable[str]) -> str:
    """The unit that all entries share, or the two that they mix."""
    return " and ".join(sorted(set(each(quantity, coordinates))))
