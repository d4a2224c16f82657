"""Sine, cosine and arc tangent as branch-free polynomials, on every lane at once.

Sine and cosine: reduction by multiples of pi/2 in three parts, then the minimax polynomials of fdlibm's kernels. Arc
tangent: the rational approximation of the Cephes library. Errors below 2 units in the last place, for arguments up to
`LARGEST_ANGLE`; tests hold them against the C library.
"""

from __future__ import annotations

import math

from flexbase.trace.targets.emitter import Emitter

LARGEST_ANGLE = 1e5  # rad: the multiple of pi/2 stays exact in the first two parts below
HALF_PI = (1.57079632673412561417e00, 6.07710050630396597660e-11, 2.02226624879595063154e-21)  # 33 + 33 + 53 bits
SINE = (
    1.58969099521155010221e-10,
    -2.50507602534068634195e-08,
    2.75573137070700676789e-06,
    -1.98412698298579493134e-04,
    8.33333333332248946124e-03,
    -1.66666666666666324348e-01,
)
COSINE = (
    -1.13596475577881948265e-11,
    2.08757232129817482790e-09,
    -2.75573143513906633035e-07,
    2.48015872894767294178e-05,
    -1.38888888888741095749e-03,
    4.16666666666666019037e-02,
)
ARC_TOP = (
    -8.750608600031904122785e-01,
    -1.615753718733365076637e01,
    -7.500855792314704667340e01,
    -1.228866684490136173410e02,
    -6.485021904942025371773e01,
)
ARC_BOTTOM = (
    1.0,
    2.485846490142306297962e01,
    1.650270098316988542046e02,
    4.328810604912902668951e02,
    4.853903996359136964868e02,
    1.945506571482613964425e02,
)


def sine_and_cosine(e: Emitter, x: str) -> tuple[str, str]:
    """sin x and cos x from one reduction: quadrant k = rint(2x/pi), then a polynomial in the rest, |r| <= pi/4."""
    k = e.call("rint", e.mul(x, e.constant(2.0 / math.pi)))
    r = x
    for part in HALF_PI:
        r = e.fma(k, e.constant(-part), r)
    z = e.mul(r, r)
    sine = e.fma(e.mul(z, r), e.polynomial(z, *SINE), r)
    half = e.mul(e.constant(0.5), z)
    head = e.sub(e.constant(1.0), half)
    tail = e.sub(e.sub(e.constant(1.0), head), half)
    cosine = e.add(head, e.fma(e.mul(z, z), e.polynomial(z, *COSINE), tail))
    odd, second_half = _odd(e, k), _odd(e, e.call("floor", e.mul(k, e.constant(0.5))))
    fourth_or_first = e.emit(f"xor {e.mask} {odd}, {second_half}")
    first, second = e.select(odd, cosine, sine), e.select(odd, sine, cosine)
    return e.select(second_half, e.neg(first), first), e.select(fourth_or_first, e.neg(second), second)


def _odd(e: Emitter, whole: str) -> str:
    """A mask of the lanes whose whole number is odd."""
    half = e.mul(whole, e.constant(0.5))
    return e.compare("une", half, e.call("floor", half))


def arc_tangent(e: Emitter, y: str, x: str) -> str:
    """atan2(y, x), 0 at the origin."""
    across, along = e.call("fabs", y), e.call("fabs", x)
    steep = e.compare("ogt", across, along)
    low, high = e.select(steep, along, across), e.select(steep, across, along)
    one, zero = e.constant(1.0), e.constant(0.0)
    high = e.select(e.compare("oeq", high, zero), one, high)
    near = e.compare("ogt", low, e.mul(high, e.constant(math.tan(math.pi / 8.0))))
    t = e.div(e.select(near, e.sub(low, high), low), e.select(near, e.add(low, high), high))
    z = e.mul(t, t)
    ratio = e.div(e.polynomial(z, *ARC_TOP), e.polynomial(z, *ARC_BOTTOM))
    angle = e.fma(e.mul(t, z), ratio, t)
    angle = e.select(near, e.add(angle, e.constant(math.pi / 4.0)), angle)
    angle = e.select(steep, e.sub(e.constant(math.pi / 2.0), angle), angle)
    backwards = e.compare("olt", x, zero)
    angle = e.select(backwards, e.sub(e.constant(math.pi), angle), angle)
    return e.call("copysign", angle, y)
