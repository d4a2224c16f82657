"""MuJoCo without its log file: left alone it writes warnings to MUJOCO_LOG.TXT in the working folder."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from flexbase.errors import import_extra


@contextmanager
def quiet_mujoco(extra: str) -> Iterator[Any]:
    """The module mujoco, whose warnings go nowhere meanwhile. Raises MissingExtra, naming the extra."""
    mujoco = import_extra("mujoco", extra)
    users_handler = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda message: None)
    try:
        yield mujoco
    finally:
        mujoco.set_mju_user_warning(users_handler)
