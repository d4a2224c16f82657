"""Undamped natural frequency and damping ratio of each mode."""

from __future__ import annotations

from flexbase.linear.reduced import RealMode
from flexbase.measures.registry import measure
from flexbase.trace.algebra import Scalar


@measure("frequency", unit="rad/s", purpose="omega_i of each mode", per_mode=True)
def frequency(mode: RealMode) -> Scalar:
    """omega = sqrt(phi^T Kp phi) with phi^T S phi = 1.  [theory §3]"""
    return mode.frequency


@measure("damping", unit="1", purpose="zeta_i of each mode", per_mode=True)
def damping(mode: RealMode) -> Scalar:
    """zeta = phi^T Dp phi / (2 omega).  [theory §3]"""
    return mode.damping_ratio
