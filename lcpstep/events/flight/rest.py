"""Rest on the obstacle, as kernels: the contact force, and the time at which the contact opens.

    lambda = -alpha / (G M^-1 G^T)

The contact lasts while the gap acceleration alpha of the free motion is not positive. Source: G. Osorio, Complex
Behavior in Impacting Systems, eq. 3.16.
"""

from __future__ import annotations

import cython

from lcpstep.events.flight.contact import NONE
from lcpstep.events.flight.motion import Flight, on_obstacle
from lcpstep.kernels.quadrature import NODES_8, WEIGHTS_8
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.pointers import abs, inf

PROBES = 4  # samples of alpha per interval while the contact is closed


def alpha_at(s: Flight, t: float) -> float:
    """Gap acceleration of the free motion, at rest on the obstacle."""
    _, _, alpha = on_obstacle(s, t, 0.0)
    return alpha


def contact_impulse(s: Flight, a: float, b: float) -> float:
    """Impulse of the contact force lambda = -alpha / (G M^-1 G^T) over (a, b) [N s]."""
    total = 0.0
    for k in range(8):
        total -= WEIGHTS_8[k] * alpha_at(s, a + NODES_8[k] * (b - a))
    return total * (b - a) / s.response


def first_release(s: Flight, a: float, alpha_a: float, b: float) -> float:
    """First time in (a, b] at which alpha turns positive, or NONE.

    It may do so for a moment between two samples; at the ends of the interval those beyond it tell, at the end of
    the motion one more before it.
    """
    h = (b - a) / PROBES
    t_0, f_0, t_1, f_1 = a - h, inf, a, alpha_a
    for k in range(1, PROBES + 2):
        t_2 = b if k == PROBES else a + k * h
        if k == PROBES + 1 and not f_0 < f_1:
            break
        if k == PROBES + 1 and t_2 > s.border():
            middle = 0.5 * (t_0 + t_1)
            top, f_top = summit(s, middle, t_1 - middle, f_0, alpha_at(s, middle), f_1)
            return alpha_root(s, t_0, f_0, top, f_top) if f_top > 0.0 else NONE
        f_2 = alpha_at(s, t_2)
        if k == 1 and f_2 <= f_1 and t_0 >= s.low:
            f_0 = alpha_at(s, t_0)
        if f_0 < f_1 and f_2 <= f_1 and f_1 <= 0.0:
            top, f_top = summit(s, t_1, h, f_0, f_1, f_2)
            start, f_start = (t_0, f_0) if k > 1 else (a, alpha_a)
            if f_top > 0.0 and start < top <= b:
                return alpha_root(s, start, f_start, top, f_top)
        if k <= PROBES and f_2 > 0.0:
            return t_1 if f_1 >= 0.0 else alpha_root(s, t_1, f_1, t_2, f_2)
        t_0, f_0, t_1, f_1 = t_1, f_1, t_2, f_2
    return NONE


def alpha_root(s: Flight, a: float, f_a: float, b: float, f_b: float) -> float:
    """Where alpha turns positive between a and b."""
    s.bracket.span(a, f_a, b, f_b)
    while s.bracket.seek(RESOLUTION * abs(s.bracket.x)):
        s.bracket.chord(alpha_at(s, s.bracket.x))
    return s.bracket.x


def summit(s: Flight, t_1: float, h: float, f_0: float, f_1: float, f_2: float) -> tuple[float, float]:
    """Highest alpha near the middle one of three equidistant samples."""
    s.turn.begin(t_1, h, -f_0, -f_1, -f_2)
    while s.turn.seek():
        s.turn.take(-alpha_at(s, s.turn.x))
    return s.turn.lowest, -s.turn.least
