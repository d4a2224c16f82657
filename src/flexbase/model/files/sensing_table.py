"""[sensing] -> how the loop really runs."""

from __future__ import annotations

from typing import Any

from flexbase.errors import InputError
from flexbase.model.files.schema import SensingTable
from flexbase.model.sensing import Sensing, checked_sensing

WHOLE = 1e-9  # relative: how far rate / task_rate may be from a whole number


def sensing_of(table: SensingTable | None, n: int, source: str) -> Sensing | None:
    """The declaration of a project with n arm joints, or None where it makes none. Raises InputError."""
    if table is None:
        return None
    where = f"{source}, [sensing] "
    given: dict[str, Any] = {name: value for name, value in table.model_dump().items() if value is not None}
    task_rate = given.pop("task_rate", None)
    if task_rate is not None:
        if "task_every" in given:
            raise InputError(f"{where}task_rate: task_every says the same. Give one of them.")
        given["task_every"] = samples_between(given.get("rate", Sensing.rate), task_rate, f"{where}task_rate")
    return checked_sensing(Sensing(**given), n, where)


def samples_between(rate: float, task_rate: float, name: str) -> int:
    """How many samples lie between two values of the task sensor. Raises InputError where it is no whole number."""
    ratio = rate / task_rate
    every = round(ratio)
    if every < 1 or abs(ratio - every) > WHOLE * ratio:
        nearest = rate / max(every, 1)
        raise InputError(
            f"{name}: {task_rate:g} Hz does not divide the rate, {rate:g} Hz. Give a part of it, such as {nearest:g}."
        )
    return every
