"""Stretches of a flight on which no contact can occur, as kernels: they are passed without looking for one.

Under accelerations of at most A the gap stays above g - |u| tau - A tau^2 / 2. Within an interval of the scan A is
taken from its ends (`suspect`); over a long stretch it is a bound that the free motion cannot exceed (`clear_until`).
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.compiled import inline
from lcpstep.events.clock import T0
from lcpstep.events.contact import EDGE_ALPHA, EDGE_G, EDGE_U, NOW
from lcpstep.events.flight.motion import (
    BEND,
    CLEAR,
    CONTACT,
    DELTA,
    DZ0,
    F0,
    OMEGA,
    PEAK,
    SCAN,
    W2,
    W_TAU,
    Y_TAU,
    Z0,
    G,
    X,
    Y,
    absolute,
)

LEAPS = 12  # at most, of an open flight
SURE = 0.95  # share of a leap that the bound allows
WORTH = 0.5  # of the scan interval: shorter leaps are not made
# How large a gap acceleration may be within an interval: relative to both ends, and to the flight's largest so far
BULGE, LEAST_BULGE = 2.0, 0.5


def suspect(x: Any, length: float, g: float, u: float, alpha: float) -> bool:
    """Whether the gap may close in an interval, by what is known at its start (EDGE) and at its end.

    Under accelerations of at most A the gap stays above both g0 - |u0| tau - A tau^2/2 and the like from the end.
    Also true where the motion is not finite.
    """
    if g - g + u - u + alpha - alpha != 0.0:
        return True
    if x[CONTACT] == 0.0:
        return False
    most = max(BULGE * max(abs(x[EDGE_ALPHA]), abs(alpha)), LEAST_BULGE * x[PEAK])
    half = 0.5 * length
    fall = 0.5 * most * half * half
    g0, u0 = x[EDGE_G], x[EDGE_U]
    opens = g0 >= 0.0 and u0 > 0.5 * most * half  # g0 + tau (u0 - A tau/2)
    clear = (opens or min(g0, g0 + u0 * half) > fall) and min(g, g - u * half) > fall
    return bool(not clear)


@inline
def hardest(x: Any) -> float:
    """Bound on |y''| in the rest of an undamped or damped flight; infinite where none is known.

    The acceleration of the remainder obeys its own equation of motion, so that its envelope only shrinks.
    """
    delta, w2 = x[DELTA], x[W2]
    a = x[F0] - 2.0 * delta * x[DZ0] - w2 * x[Z0]
    if delta == 0.0 and w2 == 0.0:
        size = abs(a)
    elif delta >= 0.0 and w2 > delta * delta:
        jerk = -2.0 * delta * a - w2 * x[DZ0]
        size = math.sqrt(a * a + (jerk + delta * a) ** 2 / (w2 - delta * delta))
    else:
        size = math.inf
    return size + x[OMEGA] * x[OMEGA] * (abs(x[X]) + abs(x[Y]))


@inline
def clear_until(s: Any, limit: float) -> float:
    """Time after the base up to which the gap is certainly open, at most `limit`; that of now where none is.

    Twice the same bound: under accelerations of at most A the gap stays above g + u tau - A tau^2/2. First for the
    gap itself, from the state at hand; then, step by step, for the height above all that the obstacle can reach,
    where only the free motion accelerates.
    """
    x = s.x
    a = x[NOW] - x[T0]
    g, u = max(x[EDGE_G], 0.0), x[EDGE_U]
    least = WORTH * x[SCAN]
    if not u + math.sqrt(u * u + 2.0 * x[BEND] * g) > least * x[BEND]:
        return a
    free_most = abs(x[G]) * hardest(x)
    most = free_most + x[BEND]
    step = SURE * (u + math.sqrt(u * u + 2.0 * most * g)) / most
    tau = a
    for _ in range(LEAPS):
        if not step > least:
            break
        tau += step
        if tau >= limit:
            return limit
        absolute(x, tau)
        height, rise = x[G] * x[Y_TAU] - x[CLEAR], x[G] * x[W_TAU]
        step = 0.0
        if height > 0.0:
            step = SURE * (rise + math.sqrt(rise * rise + 2.0 * free_most * height)) / free_most
    return tau
