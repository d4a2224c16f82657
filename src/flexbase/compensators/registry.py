"""The table of design methods: one decorator line a method, one entry for all of them."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, NamedTuple

from flexbase.checks import choose
from flexbase.control.compensator import Compensator
from flexbase.errors import InputError, nearest_name
from flexbase.plant import Pose, check_pose


class Method(NamedTuple):
    """A registered design method."""

    name: str
    purpose: str
    run: Callable[..., Compensator]


METHODS: dict[str, Method] = {}


def method(name: str, purpose: str) -> Callable[[Callable[..., Compensator]], Callable[..., Compensator]]:
    """Register a function pose, **options -> Compensator under a name."""

    def register(run: Callable[..., Compensator]) -> Callable[..., Compensator]:
        METHODS[name] = Method(name, purpose, run)
        return run

    return register


def design(pose: Pose, method: str | None = None, **options: Any) -> Compensator:
    """Design a compensator at a pose by a registered method; see `METHODS` and each method's own options.

    method : if left out, "exact" for one base joint and as many task rows as arm joints, "convex" for all others
    Raises Infeasible if the answer is no, InputError if the method or an option does not fit.
    """
    check_pose(pose)
    method = _fitting(pose, options) if method is None else method
    run = choose("method", method, METHODS).run
    known = _options_of(run)
    for option in options:
        if option not in known:
            raise InputError(f'method {method}: the option "{option}" is unknown. {nearest_name(option, known)}')
    return run(pose, **options)


def _options_of(run: Callable[..., Compensator]) -> list[str]:
    return [name for name in inspect.signature(run).parameters if name != "pose"]


def _fitting(pose: Pose, options: dict[str, Any]) -> str:
    """The usual method for an arm, or the first one that knows all the options given."""
    usual = "exact" if pose.arm.m <= 1 and pose.arm.k == pose.arm.n else "convex"
    known = (name for name in (usual, *METHODS) if set(options) <= set(_options_of(METHODS[name].run)))
    return next(known, usual)
