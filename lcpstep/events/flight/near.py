"""Flights hardly above the obstacle, as kernels: their gap from its acceleration alone.

Where the gap is far smaller than the positions of which it is the difference, it is written relative to the base of
the flight. With sigma = tau / h and alpha = alpha0 + c1 sigma + c2 sigma^2 + c3 sigma^3 through its values at three
Gauss nodes of (0, h),

    u = u0 + h (alpha0 sigma + c1 sigma^2/2 + c2 sigma^3/3 + c3 sigma^4/4)
    g = g0 + h u0 sigma + h^2 (alpha0 sigma^2/2 + c1 sigma^3/6 + c2 sigma^4/12 + c3 sigma^5/20)

which is Gauss' quadrature of degree five at the end. No difference of nearly equal positions is taken, so the
smallest hops keep all their digits, and so do those that cross a corner: there gap and velocity go on, and only the
acceleration is asked for anew.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import LOW
from lcpstep.events.flight.contact import NONE
from lcpstep.events.flight.motion import Flight, free
from lcpstep.kernels.quadratic import first_zero, highest
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.pointers import abs, min

SHORT = 0.02  # of the scan interval: the cubic resolves the acceleration to rounding
SETTLED = 1e-7  # change of the length of the longest hop that needs no further pass
PASSES = 8  # of the search for the end of a short hop; two are the rule
LONGER = 3.0  # how much longer than its guess a short hop may last
N1, N2, N3 = 0.1127016653792583, 0.5, 0.8872983346207417  # nodes of Gauss on [0, 1]


def hop_end(s: Flight, a: float, b: float) -> tuple[float, float]:
    """End of the short hop that begins at a, and the gap velocity there; NONE if none does before b."""
    if a == 0.0 and s.on_surface and s.alpha < 0.0 and (s.u > 0.0 or s.g0 > 0.0):
        guess = first_zero(s.g0, s.u, 0.5 * s.alpha)
        if guess < SHORT * s.scan:
            return short_hop(s, guess, b)
    return NONE, 0.0


def stretch(s: Flight) -> float:
    """How far the cubic is taken from the base: not beyond a corner."""
    return min(SHORT * s.scan, (s.border() - s.t0) - s.t0_rest)


def is_low(s: Flight, a: float) -> bool:
    """Whether the flight begins at a from a known gap, and stays low for a stretch."""
    if a != 0.0 or not s.on_surface:
        return False
    h = stretch(s)
    return highest(s.g0, s.u0, s.alpha0, h) <= LOW * s.size


def fit(s: Flight, h: float) -> tuple[float, float, float]:
    """The cubic of the acceleration over the first h of the flight: c1, c2, c3."""
    alpha0 = s.alpha0
    n1, n2, n3 = N1, N2, N3
    _, _, f1 = free(s, n1 * h)
    _, _, f2 = free(s, n2 * h)
    _, _, f3 = free(s, n3 * h)
    # Newton's divided differences of (alpha - alpha0) / sigma
    d1, d2, d3 = (f1 - alpha0) / n1, (f2 - alpha0) / n2, (f3 - alpha0) / n3
    d12, d23 = (d2 - d1) / (n2 - n1), (d3 - d2) / (n3 - n2)
    c3 = (d23 - d12) / (n3 - n1)
    c2 = d12 - c3 * (n1 + n2)
    return d1 - n1 * (c2 + n1 * c3), c2, c3


def along(s: Flight, level: int, h: float, sigma: float) -> float:
    """Gap (level 0), its velocity (1) or acceleration (2) at sigma of the stretch h, by the cubic s.c1 .. s.c3."""
    c1, c2, c3 = s.c1, s.c2, s.c3
    if level == 2:
        return s.alpha0 + sigma * (c1 + sigma * (c2 + sigma * c3))
    if level == 1:
        change = s.alpha0 + sigma * (c1 / 2.0 + sigma * (c2 / 3.0 + sigma * c3 / 4.0))
        return s.u0 + h * sigma * change
    change = 0.5 * s.alpha0 + sigma * (c1 / 6.0 + sigma * (c2 / 12.0 + sigma * c3 / 20.0))
    return s.g0 + h * sigma * (s.u0 + h * sigma * change)


def turn(s: Flight, level: int, h: float, a: float, b: float) -> float:
    """Where a monotone gap, velocity or acceleration changes its sign between a and b; b if it does not."""
    f_a, f_b = along(s, level, h, a), along(s, level, h, b)
    if (f_a > 0.0) == (f_b > 0.0):
        return b
    s.bracket.span(a, f_a, b, f_b)
    while s.bracket.seek(RESOLUTION * s.bracket.x):
        s.bracket.chord(along(s, level, h, s.bracket.x))
    return s.bracket.x


def first_fall(s: Flight, h: float) -> float:
    """First sigma in [0, 1] at which the gap falls to zero, or NONE; 0 where it does not even rise.

    The acceleration changes its sign at most once: that splits the velocity into monotone parts, whose changes of
    sign split the gap.
    """
    bend = turn(s, 2, h, 0.0, 1.0)
    start, g = 0.0, along(s, 0, h, 0.0)
    for k in range(4):
        end = bend if k == 1 else 1.0
        if k == 0:
            end = turn(s, 1, h, 0.0, bend)
        elif k == 2:
            end = turn(s, 1, h, bend, 1.0)
        if end > start:
            g_end = along(s, 0, h, end)
            if g_end <= 0.0:
                return turn(s, 0, h, start, end) if g > 0.0 else start
            start, g = end, g_end
    return NONE


def low_end(s: Flight, h: float) -> tuple[float, float]:
    """End of a low flight within its first h, and the gap velocity there; NONE if it is longer."""
    s.c1, s.c2, s.c3 = fit(s, h)
    sigma = first_fall(s, h)
    if sigma == NONE or sigma == 0.0:
        return sigma, 0.0
    u = along(s, 1, h, sigma)
    tau, u_hop = short_hop(s, sigma * h, h)
    # Hardly a touch is not known better than the stretch tells
    return (sigma * h, u) if tau == NONE else (tau, u_hop)


def short_hop(s: Flight, guess: float, longest: float) -> tuple[float, float]:
    """End of a hop from the base, and the gap velocity there; NONE if it is longer."""
    g0, u0, alpha0 = s.g0, s.u0, s.alpha0
    tau = guess
    for _ in range(PASSES):
        if not 0.0 < tau <= longest:
            return NONE, 0.0
        c1, c2, c3 = fit(s, tau)
        r = 1.0
        for _k in range(PASSES):
            F = u0 + tau * r * (0.5 * alpha0 + r * (c1 / 6.0 + r * (c2 / 12.0 + r * c3 / 20.0)))
            dF = tau * (0.5 * alpha0 + r * (c1 / 3.0 + r * (c2 / 4.0 + r * c3 / 5.0)))
            if g0 != 0.0:
                F += g0 / (tau * r)
                dF -= g0 / (tau * r * r)
            step = -F / dF if dF < 0.0 else 1.0
            r += step
            if abs(step) <= RESOLUTION or not 0.0 < r < LONGER:
                break
        if not 0.0 < r < LONGER:
            return NONE, 0.0
        tau *= r
        # The nodes were those of another length: the cubic's error beyond them, times by how much it was another
        longer = SHORT * s.scan / tau
        longer *= longer
        if abs(r - 1.0) <= SETTLED * (longer * longer):
            if tau > longest:
                return NONE, 0.0
            return tau, u0 + tau * (alpha0 + r * (c1 / 2.0 + r * (c2 / 3.0 + r * c3 / 4.0)))
    return NONE, 0.0
