"""E designed through the sampled loop itself, with the lags and delays that it will meet.  [theory §10]"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np

from flexbase.cautions import collected
from flexbase.checks import Array
from flexbase.compensators.judge.implementable import RADIUS
from flexbase.compensators.registry import design
from flexbase.errors import Infeasible, InputError, MissingExtra
from flexbase.linear.discrete.affine_loop import AffineLoop, Piece
from flexbase.linear.discrete.system import Discrete, series, side_by_side, static
from flexbase.linear.modal import modes
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.requests import Says
from flexbase.sampled.closed import plant_at_one_rate, plants_in_a_period
from flexbase.sampled.controller import (
    SampledController,
    acceleration_estimator,
    pd_with_gain,
    self_motion_gains,
)
from flexbase.synthesis.registry import hardware_method
from flexbase.synthesis.search.minimax import Found, Landscape, descend

ENOUGH_MARGIN = 0.6  # disk margin beyond which more is not asked for
SLOW, SLOW_WEIGHT, SLOWEST = 0.05, 0.05, 3.0  # [s]: 0.05 min(tau / 50 ms, 3) is added to the objective
UNSTABLE = 10.0  # beside the radius: worse than every stable loop
SHARE = 0.4  # of the ideal design, where the second descent starts
TRIED = 12  # looks from each start, before the best goes on
GUESSES, SPREAD = 2, 0.3  # random starts, and the size of their entries in units of Ms
SCALES = ("stiffness", "damping", "joint-damping")
MATRICES = "matrices"
FREE = ("E", *SCALES, MATRICES)
HIGHEST = 3.0  # factor on a gain, less one; joint damping in its unit
JOINT_DAMPING = 100.0  # 1/s: unit of joint damping, times Ms


@hardware_method(
    "sampled",
    "an E made for the sampled loop itself; 4 kHz and more, or soft gains",
    as_given={"most": 40},
    law="gains",
)
def sampled(
    pose: Pose,
    sensing: Sensing,
    gains: Gains,
    *,
    free: Annotated[tuple[str, ...], Says("of E, stiffness, damping, joint-damping, matrices")] = ("E",),
    softest: Annotated[float, Says("lowest factor on the stiffness", written="G")] = 0.3,
    sensors: bool = True,
    most: Annotated[int, Says("looks in a descent")] = 60,
) -> SampledController:
    """E, and where asked scales of the gains and joint damping, for the largest disk margin of the sampled loop.

    A redundant arm's self-motion is damped as `pd_with_gain` damps it without E.

    Minimises -min(margin, 0.6) + 0.05 min(tau / 50 ms, 3), tau the slowest time constant; where the loop is unstable,
    its spectral radius. Descends by sequential linear programmes with exact slopes: some steps from no E, from 0.4
    times the ideal design and from two random gains (always the same), then on from the best. E is symmetric; nothing
    else is asked of it: the sampled loop tells whether it can be built.

    free : of "E", "stiffness" and "damping" (a factor on each gain, up to 4), "joint-damping" (a factor on Ms, up to
        400/s), "matrices" (every entry of the gains on tip rate, joint rate and acceleration)
    softest : lowest factor on the stiffness, and its root on the damping
    sensors : the margin is the smaller of those at torques and sensors; else that at the torques
    most : looks at the loop in a descent
    Raises InputError. `notes` has the objective, the looks, and the scales.
    """
    problem = SampledProblem(pose, sensing, gains, free, sensors, softest)
    tried = [descend(problem.look, start, min(TRIED, most)) for start in problem.starts()]
    best = descend(problem.look, min(tried, key=lambda one: one.value).x, most)
    return problem.controller(best, best.looks + sum(one.looks for one in tried))


class SampledProblem:
    """The loop of a pose with E and scales as unknowns x, all of order one."""

    def __init__(
        self,
        pose: Pose,
        sensing: Sensing,
        gains: Gains,
        free: Sequence[str] = ("E",),
        sensors: bool = True,
        softest: float = 0.3,
    ) -> None:
        for name in free:
            if name not in FREE:
                raise InputError(f'free: "{name}" is unknown. Give some of {", ".join(FREE)}.')
        self.pose, self.sensing, self.gains, self.free, self.sensors = pose, sensing, gains, tuple(free), sensors
        self.lowest = {"stiffness": softest - 1.0, "damping": softest**0.5 - 1.0, "joint-damping": 0.0}
        n, k, Jv = pose.arm.n, pose.arm.k, pose.Jv
        self.Ls = np.linalg.cholesky(pose.Ms)
        self.pairs = [(i, j) for i in range(n) for j in range(i, n)] if "E" in free else []
        blank = np.zeros((n, 2 * k + 3 * n))
        self.proportional, self.rate, self.joints = blank.copy(), blank.copy(), blank.copy()
        self.proportional[:, :k], self.rate[:, k : 2 * k] = -Jv.T @ gains.stiffness, -Jv.T @ gains.damping
        self.joints[:, 2 * k : 2 * k + n] = -JOINT_DAMPING * self.Ls @ self.Ls.T
        self.units = np.array([*map(self._unit, self.pairs), *self._scales()]).reshape(-1, *blank.shape)
        self.fixed = self.proportional + self.rate
        if n > k:
            stiffness, damping = self_motion_gains(pose, None)
            self.fixed[:, 2 * k : 2 * k + n] -= damping
            self.fixed[:, 2 * k + n : 2 * k + 2 * n] -= stiffness
        self.on_joints = n > k or "joint-damping" in free or MATRICES in free
        used = [*range(k)]
        used += [*range(k, k + n)] if self.on_joints or sensing.acceleration != "accelerometer" else []
        felt = bool(self.pairs) or MATRICES in free
        used += [*range(k + n, k + 2 * n)] if sensing.acceleration == "accelerometer" and felt else []
        plants = [plant.select(inputs=list(range(n))) for plant in plants_in_a_period(pose, sensing)]
        seen = signals(pose, sensing)
        self.loop = AffineLoop(plants, plant_at_one_rate(pose, sensing), seen, tuple(used))

    def _unit(self, pair: tuple[int, int]) -> Array:
        """What one unknown of E adds to Theta: an entry of W in E = Ls W Ls^T."""
        W = np.zeros_like(self.Ls)
        W[pair] = W[pair[::-1]] = 1.0
        unit = np.zeros_like(self.proportional)
        unit[:, -len(W) :] = self.Ls @ W @ self.Ls.T
        return unit

    def _scales(self) -> list[Array]:
        known = {"stiffness": self.proportional, "damping": self.rate, "joint-damping": self.joints}
        scales = [unit for name, unit in known.items() if name in self.free]
        return scales if MATRICES not in self.free else [*scales, *self._entries()]

    def _entries(self) -> list[Array]:
        """Single entries of the gains on tip rate, joint rate and acceleration, each in the unit of its kind."""
        k, n = self.pose.arm.k, len(self.Ls)
        if not self.gains.damping.any():
            raise Infeasible(f"{self.pose.plant.name}: no task damping to search around. Give one above 0.")
        Lk = np.linalg.cholesky(self.gains.damping + 1e-9 * np.trace(self.gains.damping) * np.eye(k))
        pull, Ls = -self.pose.Jv.T @ Lk, self.Ls
        sides = [(k, pull, Lk.T), (2 * k, -JOINT_DAMPING * Ls, Ls.T), (2 * k + 2 * n, Ls, Ls.T)]
        found = []
        for first, left, right in sides:
            for i, j in np.ndindex(left.shape[1], right.shape[0]):
                unit = np.zeros_like(self.proportional)
                unit[:, first : first + right.shape[1]] = np.outer(left[:, i], right[j])
                found.append(unit)
        return found

    def theta(self, x: Array) -> Array:
        """The constant matrix from signals to torques; x = 0 is the task PD alone."""
        return self.fixed + np.tensordot(self._bounded(x), self.units, 1)

    def _bounded(self, x: Array) -> Array:
        """Scales within their bounds, all else as it is."""
        count = len(self.pairs)
        names = [name for name in SCALES if name in self.free]
        scales = np.clip(x[count : count + len(names)], [self.lowest[name] for name in names], HIGHEST)
        return np.concatenate([x[:count], scales, x[count + len(names) :]])

    def look(self, x: Array) -> Landscape:
        """The objective and its slopes at x."""
        return landscape(self.loop, self.theta(x), self.units, self.sensors)

    def starts(self) -> list[Array]:
        """No E, a share of the ideal design where there is one, and random ones: the landscape has several valleys."""
        none, count = np.zeros(len(self.units)), len(self.pairs)
        if not count:
            return [none]
        E = ideal_gain(self.pose)
        W = [] if E is None else [np.linalg.solve(self.Ls, np.linalg.solve(self.Ls, SHARE * E).T)]
        draw = np.random.default_rng(0)
        guesses = [np.array([one[pair] for pair in self.pairs]) for one in W]
        guesses += [SPREAD * draw.standard_normal(count) for _ in range(GUESSES)]
        return [none, *(np.concatenate([one, none[count:]]) for one in guesses)]

    def controller(self, found: Found, looks: int) -> SampledController:
        """The controller at x, and notes on how it was found."""
        x, theta = self._bounded(found.x), self.theta(found.x)
        names, count = [name for name in SCALES if name in self.free], len(self.pairs)
        values = dict(zip(names, x[count : count + len(names)].tolist(), strict=True))
        E = theta[:, -len(self.Ls) :] if self.pairs or MATRICES in self.free else None
        used = Gains(
            (1.0 + values.get("stiffness", 0.0)) * self.gains.stiffness,
            (1.0 + values.get("damping", 0.0)) * self.gains.damping,
        )
        if self.on_joints:
            law = series(signals(self.pose, self.sensing), static(theta, self.sensing.step))
            made = SampledController("sampled", self.pose, self.sensing, law, E)
        else:
            made = pd_with_gain(self.pose, self.sensing, used, E, "sampled")
        made.notes.update(
            objective=found.value,
            looks=looks,
            stiffness_scale=float(1.0 + values.get("stiffness", 0.0)),
            damping_scale=float(1.0 + values.get("damping", 0.0)),
            joint_damping=float(JOINT_DAMPING * values.get("joint-damping", 0.0)),
        )
        return made


def landscape(loop: AffineLoop, theta: Array, units: Array, sensors: bool = True) -> Landscape:
    """The objective of `sampled` at a matrix, and its slopes by shares of the `units` that are added to it."""
    poles = loop.poles(theta)
    radius = poles[0].value
    if radius >= 1.0:
        return Landscape(UNSTABLE + radius, (_group(poles, units),))
    margins = loop.margins(theta, sensors)
    tightest = min(min(piece.value for piece in margins), ENOUGH_MARGIN)
    # -log radius is the decay a sample: its inverse is the time constant, linear where it is largest
    step = loop.averaged.step
    tau = -step / np.log(radius)
    slow = [
        Piece(
            SLOW_WEIGHT * (-step / np.log(one.value)) / SLOW,
            SLOW_WEIGHT / SLOW * step / (one.value * np.log(one.value) ** 2) * one.slope,
        )
        for one in poles
        if 0.0 < one.value < 1.0
    ]
    flat = Piece(-ENOUGH_MARGIN, np.zeros_like(theta))
    if tau >= SLOWEST * SLOW:
        slow = [Piece(SLOW_WEIGHT * SLOWEST, np.zeros_like(theta))]
    groups = [*(Piece(-one.value, -one.slope) for one in margins), flat], slow
    return Landscape(
        -tightest + SLOW_WEIGHT * min(tau / SLOW, SLOWEST), tuple(_group(pieces, units) for pieces in groups)
    )


def _group(pieces: Sequence[Piece], units: Array) -> tuple[Array, Array]:
    values = np.array([piece.value for piece in pieces])
    return values, np.tensordot(np.array([piece.slope for piece in pieces]), units, ((1, 2), (1, 2)))


def signals(pose: Pose, sensing: Sensing) -> Discrete:
    """From tip error, joints and accelerations to (e, de, dq, q, a), each difference over its own interval."""
    n, k = pose.arm.n, pose.arm.k
    step, every = sensing.step, sensing.task_every
    size = k * every
    rate = 1.0 / (every * step)
    last = np.hstack([np.zeros((k, size - k)), np.eye(k)])
    tip = Discrete(
        np.eye(size, k=-k),
        np.eye(size, k),
        np.vstack([np.zeros((k, size)), -rate * last]),
        np.vstack([np.eye(k), rate * np.eye(k)]),
        step,
    )
    direct = np.vstack([np.eye(n) / step, np.eye(n)])
    joints = Discrete(np.zeros((n, n)), np.eye(n), np.vstack([-np.eye(n) / step, np.zeros((n, n))]), direct, step)
    if sensing.acceleration == "accelerometer":
        return side_by_side(tip, joints, static(np.eye(n), step))
    split = static(np.vstack([np.eye(n), np.eye(n)]), step)
    from_encoders = series(split, side_by_side(joints, acceleration_estimator(n, sensing)))
    unused = static(np.zeros((0, n)), step)
    return side_by_side(tip, from_encoders, unused)


def ideal_gain(pose: Pose) -> Array | None:
    """The implementable design for ideal acceleration that suits the base; None where there is none."""
    if pose.arm.m == 0:
        return None
    tries: list[tuple[str, dict[str, Any]]] = [("bounded", {}), ("convex", {"radius": RADIUS})]
    if pose.arm.m == 1 and pose.arm.k == pose.arm.n:
        tries.insert(0, ("exact", {"natural_frequency": modes(pose)[0].frequency + 100.0}))
    for method, options in tries:
        try:
            with collected(quietly=True):  # a start: what comes of it is judged by itself
                return design(pose, method=method, **options).E
        except (Infeasible, InputError, MissingExtra):
            continue
    return None
