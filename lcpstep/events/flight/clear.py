"""Stretches of a flight on which no contact can occur, as kernels: they are passed without looking for one.

Under accelerations of at most A the gap stays above g - |u| tau - A tau^2 / 2. Within an interval of the scan A is
taken from its ends (`suspect`); over a long stretch it is a bound that the free motion cannot exceed (`clear_until`).
"""

from __future__ import annotations

from math import sqrt

import cython

from lcpstep.events.flight.motion import Flight, absolute
from lcpstep.events.flight.oscillator import envelope
from lcpstep.pointers import abs, inf, max, min

LEAPS = 12  # at most, of an open flight
SURE = 0.95  # share of a leap that the bound allows
WORTH = 0.5  # of the scan interval: shorter leaps are not made
# How large a gap acceleration may be within an interval: relative to both ends, and to the flight's largest so far
BULGE, LEAST_BULGE = 2.0, 0.5


def suspect(s: Flight, length: float, g: float, u: float, alpha: float) -> bool:
    """Whether the gap may close in an interval, by what is known at its start (s.g, s.u, s.alpha) and at its end.

    Under accelerations of at most A the gap stays above both g0 - |u0| tau - A tau^2/2 and the like from the end.
    Also true where the motion is not finite.
    """
    if g - g + u - u + alpha - alpha != 0.0:
        return True
    if not s.contact:
        return False
    most = max(BULGE * max(abs(s.alpha), abs(alpha)), LEAST_BULGE * s.peak)
    half = 0.5 * length
    fall = 0.5 * most * half * half
    g0, u0 = s.g, s.u
    opens = g0 >= 0.0 and u0 > 0.5 * most * half  # g0 + tau (u0 - A tau/2)
    clear = (opens or min(g0, g0 + u0 * half) > fall) and min(g, g - u * half) > fall
    return not clear


def hardest(s: Flight) -> float:
    """Bound on |y''| in the rest of an undamped or damped flight; infinite where none is known.

    The acceleration of the remainder obeys its own equation of motion.
    """
    delta, w2 = s.delta, s.w2
    a = s.f0 - 2.0 * delta * s.dz0 - w2 * s.z0
    if delta == 0.0 and w2 == 0.0:
        size = abs(a)
    elif delta >= 0.0 and w2 > delta * delta:
        size = envelope(delta, w2, a, -2.0 * delta * a - w2 * s.dz0)
    else:
        size = inf
    return size + s.Omega * s.Omega * (abs(s.X) + abs(s.Y))


def clear_until(s: Flight, limit: float) -> float:
    """Time after the base up to which the gap is certainly open, at most `limit`; that of now where none is.

    Twice the same bound: under accelerations of at most A the gap stays above g + u tau - A tau^2/2. First for the
    gap itself, from the state at hand; then, step by step, for the height above all that the obstacle can reach,
    where only the free motion accelerates.
    """
    a = s.now - s.t0
    g, u = max(s.g, 0.0), s.u
    least = WORTH * s.scan
    if not u + sqrt(u * u + 2.0 * s.bend * g) > least * s.bend:
        return a
    free_most = abs(s.G) * hardest(s)
    most = free_most + s.bend
    step = SURE * (u + sqrt(u * u + 2.0 * most * g)) / most
    tau = a
    for _ in range(LEAPS):
        if not step > least:
            break
        tau += step
        if tau >= limit:
            return limit
        absolute(s, tau)
        height, rise = s.G * s.y_tau - s.clear, s.G * s.w_tau
        step = 0.0
        if height > 0.0:
            step = SURE * (rise + sqrt(rise * rise + 2.0 * free_most * height)) / free_most
    return tau
