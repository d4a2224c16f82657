"""An arm on a compliant base, with its task: everything that a project file says."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from flexbase.checks import Array
from flexbase.model.base import Base
from flexbase.model.mechanism import Mechanism
from flexbase.model.parts import Parts, base_first
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains, Task


@dataclass(frozen=True, eq=False)
class MountedArm:
    """A mechanism whose first m joints are the base.

    gravity : acceleration of free fall in world axes, shape (3,) [m/s^2]; zero is the paper's case
    gains : default task gains, or None
    sensing : how the loop really runs, or None where the project does not say
    """

    name: str
    mechanism: Mechanism
    base: Base
    task: Task
    gravity: Array
    gains: Gains | None = None
    sensing: Sensing | None = None

    @property
    def m(self) -> int:
        """Number of passive base joints."""
        return self.base.m

    @property
    def N(self) -> int:
        """Number of joints, base and arm."""
        return self.mechanism.N

    @property
    def n(self) -> int:
        """Number of actuated arm joints."""
        return self.N - self.m

    @property
    def k(self) -> int:
        """Number of task rows."""
        return self.task.k

    @cached_property
    def parts(self) -> Parts:
        """Which joints are passive and which active: `parts.arm(q)`, `parts.base(q)`, `parts.blocks(M)`."""
        return base_first(self.m, self.N)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the arm joints."""
        return self.parts.arm(self.mechanism.joint_names)

    @property
    def joint_units(self) -> tuple[str, ...]:
        """Unit of each arm joint's coordinate, rad or m."""
        return self.parts.arm(self.mechanism.joint_units)

    @property
    def has_gravity(self) -> bool:
        """Whether gravity acts."""
        return bool(self.gravity.any())
