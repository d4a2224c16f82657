"""Negative imaginariness of P(s), force to displacement: i (P - P*) >= 0 at every positive frequency.  [theory §5]

P is negative imaginary exactly where G = s P is positive real, P strictly proper, R0 = R0^T >= 0: on the axis
i (P - P*) is (G + G*)/omega, a rigid motion R0/s^2 adds nothing to it, and an undamped mode must have R = R^T >= 0.
Weighted by 1/omega it looks harder at slow motions, so its shortage is a number of its own.
"""

from __future__ import annotations

from typing import NamedTuple

from flexbase.linear.passivity.level_search import Interval
from flexbase.linear.passivity.passivity_index import input_index, largest_gain
from flexbase.linear.passivity.stable_part import compressed
from flexbase.linear.passivity.vibration import Vibration


class NegativeImaginary(NamedTuple):
    """inf of lambda_min(i (P - P*)/2) over omega > 0, 0 where it is positive, and the same over max |P - R0/s^2|.

    at : where it is worst [rad/s]
    """

    shortage: float
    relative: float
    at: float
    settled: bool


def negative_imaginary(vibration: Vibration, band: Interval) -> NegativeImaginary | None:
    """How far the damped part of P is from negative imaginary over a band [rad/s].

    None where a motion against friction alone makes P infinite at rest: G then decides.
    """
    port = vibration.force_to_displacement()
    if port is None:
        return None
    port = compressed(port)
    gain = largest_gain(port, band)
    worst = input_index(port, gain.value, band)
    shortage = min(worst.value, 0.0)
    relative = shortage / gain.value if gain.value > 0.0 else 0.0
    return NegativeImaginary(shortage, relative, worst.at, gain.settled and worst.settled)
