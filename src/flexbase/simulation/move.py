"""What is asked of a run: its times, its laws, its physics. Python and command line share these requests."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexbase.checks import check_request, positive_number
from flexbase.control.joint_tracking import BANDWIDTH
from flexbase.control.trajectories import LAWS
from flexbase.errors import InputError
from flexbase.requests import asked
from flexbase.sampled.controller import SELF_MOTION
from flexbase.simulation.plants.engines import ENGINES
from flexbase.simulation.settling import SETTLED

LARGEST = 1_000_000  # samples of a run
SAMPLED_BANDWIDTH = 20.0  # rad/s of joint tracking: 40 is unstable at 1 kHz in the start pose of the paper's move
TOLERANCE = 1e-8  # rad or m of a joint


@dataclass(frozen=True, kw_only=True)
class IdealMove:
    """What `simulate` and `simulate_many` share: joint tracking, then the task-space law, in continuous time. Abstract.

    Until `switch` the joints follow a straight path in joint space; from then to `end` the task-space law settles the
    tip. compensate : the compensator acts from the switch on (it was designed for the goal), or always
    """

    trajectory: str = asked("quintic", "how the joints move", choices=tuple(LAWS))
    switch: float = asked(0.1, "task-space loop takes over", unit="s", written="S")
    end: float = asked(0.4, "end of the run", unit="s", written="S")
    compensate: str = asked("settle", "compensator acts from the switch on, or always", choices=("settle", "always"))
    bandwidth: float = asked(BANDWIDTH, "of joint tracking", unit="rad/s", written="W")
    self_motion: float = asked(
        SELF_MOTION, "redundant arms: frequency of the null-space damping, or 0 for none", unit="rad/s", written="W"
    )

    def _check(self) -> None:
        if not 0.0 < self.switch < self.end < np.inf:
            raise InputError(
                f"times: switch ({self.switch:g} s) must lie above 0 and below end ({self.end:g} s). Give such times."
            )
        positive_number("bandwidth", self.bandwidth, "rad/s")
        if not 0.0 <= self.self_motion < np.inf:
            raise InputError(f"self_motion: {self.self_motion:g} rad/s is none. Give one from 0 (no damping) up.")


@dataclass(frozen=True, kw_only=True)
class Move(IdealMove):
    """How `simulate` makes its move. interval : between samples of the result; engine : what answers the laws."""

    interval: float = asked(2e-4, "between samples", unit="s", written="S")
    engine: str = asked("builtin", "physics", choices=tuple(ENGINES))

    def checked(self) -> Move:
        """The request, if it makes sense. Raises InputError."""
        check_request("move", self, Move)
        self._check()
        least, most = self.end / LARGEST, self.end - self.switch
        if not least <= self.interval <= most:
            raise InputError(f"times: interval ({self.interval:g} s) must lie from {least:g} to {most:g} s.")
        return self


@dataclass(frozen=True, kw_only=True)
class Moves(IdealMove):
    """How `simulate_many` makes its moves.

    tolerance : halving the steps moves no joint by more; threads : all cores if left out
    """

    tolerance: float = asked(TOLERANCE, "of a joint, by the steps", unit="rad or m", written="X")
    threads: int | None = asked(None, "threads; all cores if left out")

    def checked(self) -> Moves:
        """The request, if it makes sense. Raises InputError."""
        check_request("move", self, Moves)
        self._check()
        positive_number("tolerance", self.tolerance, "rad or m")
        if self.threads is not None and self.threads < 1:
            raise InputError(f"threads: {self.threads} is none. Give 1 or more, or None for all cores.")
        return self


@dataclass(frozen=True, kw_only=True)
class SampledMove:
    """How `simulate_sampled` makes its move.

    Until `switch` the joints track a straight path in joint space; from then on, with 0 at once, the sampled controller
    has the arm. tolerance : tip error that counts as settled; seed : of all noise
    """

    trajectory: str = asked("quintic", "how the joints move", choices=tuple(LAWS))
    switch: float = asked(0.0, "controller takes over from joint tracking", unit="s", written="S")
    end: float = asked(0.5, "end of the run", unit="s", written="S")
    bandwidth: float = asked(SAMPLED_BANDWIDTH, "of joint tracking", unit="rad/s", written="W")
    engine: str = asked("builtin", "physics", choices=tuple(ENGINES))
    tolerance: float = asked(SETTLED, "tip error that counts as settled", unit="m, rad", written="X")
    seed: int = asked(0, "of all noise")

    def checked(self) -> SampledMove:
        """The request, if it makes sense. Raises InputError."""
        check_request("move", self, SampledMove)
        if not 0.0 <= self.switch < self.end < np.inf:
            raise InputError(
                f"times: switch ({self.switch:g} s) must lie from 0 to below end ({self.end:g} s). Give such times."
            )
        positive_number("bandwidth", self.bandwidth, "rad/s")
        positive_number("tolerance", self.tolerance, "m or rad")
        if self.seed < 0:
            raise InputError(f"seed: {self.seed} is below 0. Give a whole number from 0 up.")
        return self
