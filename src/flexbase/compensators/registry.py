"""The table of design methods: one decorator line a method, one entry for all of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from flexbase.checks import check_options, choose
from flexbase.control.compensator import Compensator
from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Pose, check_pose
from flexbase.requests import Option, options_of


class Method(NamedTuple):
    """A registered design method: run(pose, loop=..., **options)."""

    name: str
    purpose: str
    run: Callable[..., Compensator]

    @property
    def options(self) -> tuple[Option, ...]:
        """What its signature says about its options."""
        return options_of(self.run)


METHODS: dict[str, Method] = {}


def method(name: str, purpose: str) -> Callable[[Callable[..., Compensator]], Callable[..., Compensator]]:
    """Register a function pose, *, options, loop -> Compensator under a name; its options are annotated with `Says`."""

    def register(run: Callable[..., Compensator]) -> Callable[..., Compensator]:
        METHODS[name] = Method(name, purpose, run)
        return run

    return register


def design(pose: Pose, method: str | None = None, loop: Asked = None, **options: Any) -> Compensator:
    """Design a compensator at a pose by a registered method; see `METHODS` and each method's own options.

    method : if left out, "exact" for one base joint and as many task rows as arm joints, "convex" for all others
    loop : whose task gains the certificate closes the loop with; the project's own if left out
    Raises Infeasible if the answer is no, InputError if the method or an option does not fit.
    """
    check_pose(pose)
    loop_on(pose.arm, loop).check_bare()
    method = _fitting(pose, options) if method is None else method
    run = choose("method", method, METHODS).run
    check_options(method, run, options)
    return run(pose, loop=loop, **options)


def _fitting(pose: Pose, options: dict[str, Any]) -> str:
    """The usual method for an arm, or the first one that knows all the options given."""
    usual = "exact" if pose.arm.m <= 1 and pose.arm.k == pose.arm.n else "convex"
    known = (name for name in (usual, *METHODS) if set(options) <= {one.name for one in METHODS[name].options})
    return next(known, usual)
