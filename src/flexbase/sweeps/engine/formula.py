"""A question that is a formula: one generic function, a configuration and parameters in, a status and measures out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from flexbase.checks import Array
from flexbase.dynamics.inverse.two_joint_arm import TwoJointArm, two_joint_angles
from flexbase.measures import Configuration, Measure, exact_design
from flexbase.model.digest import model_digest
from flexbase.model.mounted import MountedArm
from flexbase.plant import SINGULAR as SINGULAR_RATIO
from flexbase.sweeps.cells.parameters import configuration_of
from flexbase.sweeps.engine.status import INDEFINITE, INFEASIBLE, OK, SINGULAR, UNREACHABLE
from flexbase.trace.algebra import Matrix, Scalar, Vector, absolute, independence, ldl, select

STRETCHED = 1.0 + 1e-12  # cosine of the elbow, to rounding, at the edge of reach
NAN = float("nan")


@dataclass(frozen=True, eq=False)
class Formula:
    """Measures of a configuration, as one generic function of scalars.

    measures : those that the generic function evaluates, and the slow ones, which follow by LAPACK
    varied : which coordinates are inputs, in this order; `held` : all coordinates, used where they are not
    parameters : names of further inputs
    planar : coordinates are the tip's in the plane of this two-joint arm; None: they are the n arm joints
    side : the elbow's, +1 or -1, with `planar`
    redesigned : instead of E, the exact design of each cell, made for the nominal plant and kept while parameters vary
    """

    arm: MountedArm
    measures: tuple[Measure, ...]
    varied: tuple[int, ...]
    held: tuple[float, ...]
    parameters: tuple[str, ...] = ()
    E: Array | None = None
    planar: TwoJointArm | None = None
    side: float = 1.0
    redesigned: bool = False

    @property
    def inputs(self) -> int:
        """How many scalars enter."""
        return len(self.varied) + len(self.parameters)

    @property
    def quick(self) -> tuple[Measure, ...]:
        """The measures of the generic function."""
        return tuple(one for one in self.measures if not one.slow)

    def width(self, one: Measure) -> int:
        """How many values a measure has in each cell."""
        return self.arm.m if one.per_mode else 1

    def __call__(self, inputs: Vector) -> list[Scalar]:
        """Status, then the values of the quick measures, NaN where they have none."""
        joints, reached = self._joints(inputs)
        configuration = self.configuration(inputs, joints)
        pivots = [*configuration.reduced.pivots, *(ldl(configuration.reduced.S)[1] if self.arm.m else ())]
        status: Scalar = float(OK)
        for pivot in pivots:
            status = select(pivot > 0.0, status, float(INDEFINITE))
        if self.redesigned:
            status = select(exact_design.feasible(self._nominal(joints)), status, float(INFEASIBLE))
        ratio = independence(tuple(map(self.arm.parts.arm, configuration.J)))
        status = select(ratio > SINGULAR_RATIO, status, float(SINGULAR))
        status = select(reached, status, float(UNREACHABLE))
        usable, values = status == float(OK), []
        for one in self.quick:
            allowed = usable
            if one.feasible is not None:
                exists = one.feasible(configuration)
                status = select(exists, status, select(usable, float(INFEASIBLE), status))
                allowed = status == float(OK)
            values += [select(allowed, value, NAN) for value in self._values(one, configuration)]
        return [status, *values]

    def _values(self, one: Measure, configuration: Configuration) -> list[Scalar]:
        return [one.run(mode) for mode in configuration.modes] if one.per_mode else [one.run(configuration)]

    def configuration(self, inputs: Vector, joints: Vector | None = None) -> Configuration:
        """What measures read of a cell."""
        known = self._joints(inputs)[0] if joints is None else joints
        parameters = dict(zip(self.parameters, inputs[len(self.varied) :], strict=True))
        return configuration_of(self.arm, known, parameters, self._gain(known))

    def _gain(self, joints: Vector) -> Matrix | None:
        if self.redesigned:
            return exact_design.exact_E(self._nominal(joints))
        return None if self.E is None else self.E.tolist()

    def _nominal(self, joints: Vector) -> Configuration:
        return configuration_of(self.arm, joints, {}, None)

    def _joints(self, inputs: Vector) -> tuple[Vector, Scalar]:
        """Arm joints, and whether there are any."""
        place = list(self.held)
        for i, value in zip(self.varied, inputs, strict=False):
            place[i] = value
        if self.planar is None:
            return tuple(place), True
        first, second, cosine = two_joint_angles(self.planar, place[0], place[1], self.side)
        return (first, second), absolute(cosine) <= STRETCHED

    @cached_property
    def recipe(self) -> str:
        """All that the answers depend on, in words: equal recipes have equal answers."""
        E = "none" if self.E is None else self.E.tobytes().hex()
        names = ",".join(one.name for one in self.measures)
        return (
            f"model {model_digest(self.arm)}\nmeasures {names}\nvaried {self.varied}\nheld {self.held!r}\n"
            f"parameters {self.parameters}\nE {E}\nplanar {self.planar is not None} {self.side}\n"
            f"redesigned {self.redesigned}"
        )
