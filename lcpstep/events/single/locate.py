"""Where a gap closes, as kernels: roots that are bracketed before they are polished.

On an interval short enough for the gap acceleration to change its sign at most once, that sign change splits the
gap velocity into monotone parts, whose sign changes split the gap into monotone parts. So the first root of the gap
is found even where the gap dips below zero and returns within the interval (grazing). Source of the polishing:
Newton's method safeguarded by bisection, W. Press et al., Numerical Recipes, section 9.4.
"""

from __future__ import annotations

from typing import Any

from lcpstep.events.clock import RESOLUTION
from lcpstep.events.contact import NONE
from lcpstep.events.single.motion import contact_at, gap_acceleration, near_surface

MAX_ITERATIONS = 100
PROBES = 8  # samples of the gap acceleration per interval while the contact is closed


def root(s: Any, level: int, a: float, f_a: float, b: float, f_b: float) -> float:
    """Root between a and b of the gap (level 0), its velocity (1) or acceleration (2); f_a f_b <= 0."""
    if f_a == 0.0:
        return a
    x, f_x = (b, f_b) if abs(f_b) < abs(f_a) else (a, f_a)
    slope = (f_b - f_a) / (b - a)
    step = before = b - a
    for _ in range(MAX_ITERATIONS):
        if f_x == 0.0:
            return x
        x_new = x - f_x / slope if slope != 0.0 else a
        if not (a < x_new < b) or abs(x_new - x) > 0.5 * abs(before):
            x_new = 0.5 * (a + b)
        before, step = step, x_new - x
        x_old, f_old, x = x, f_x, x_new
        g, u, alpha = contact_at(s, x)
        f_x = g if level == 0 else (u if level == 1 else alpha)
        if (f_x > 0.0) == (f_a > 0.0):
            a, f_a = x, f_x
        else:
            b = x
        slope = u if level == 0 else (alpha if level == 1 else (f_x - f_old) / (x - x_old))
        if abs(step) <= RESOLUTION * abs(x) or b - a <= RESOLUTION * abs(x):
            x_new = x - f_x / slope if slope != 0.0 else x
            return x_new if abs(x_new - x) <= 4.0 * RESOLUTION * abs(x) else x
    return x


def first_contact(
    s: Any, a: float, at_a: tuple[float, float, float], b: float, at_b: tuple[float, float, float]
) -> float:
    """First time in (a, b] at which the gap falls to zero, or NONE; at_a, at_b: gap, velocity, acceleration."""
    middle, at_middle = b, at_b
    if at_a[2] * at_b[2] < 0.0:
        middle = root(s, 2, a, at_a[2], b, at_b[2])
        at_middle = contact_at(s, middle)
    found = first_in_half(s, a, at_a, middle, at_middle)
    if found == NONE and middle < b:
        found = first_in_half(s, middle, at_middle, b, at_b)
    return found


def first_in_half(
    s: Any, a: float, at_a: tuple[float, float, float], b: float, at_b: tuple[float, float, float]
) -> float:
    """The same where the gap velocity is monotone."""
    if at_a[1] * at_b[1] < 0.0:
        middle = root(s, 1, a, at_a[1], b, at_b[1])
        g, _, _ = contact_at(s, middle)
        if at_a[1] < 0.0 and at_a[0] > 0.0 and g <= 0.0:
            return root(s, 0, a, at_a[0], middle, g)
        if at_a[1] > 0.0 and at_b[0] <= 0.0:
            return middle if g <= 0.0 else root(s, 0, middle, g, b, at_b[0])
        return NONE
    if at_a[0] > 0.0 and at_b[0] <= 0.0:
        return root(s, 0, a, at_a[0], b, at_b[0])
    return NONE


def short_hop(s: Any, guess: float, longest: float) -> float:
    """End of a hop that left the surface at the base of the piece, or NONE if it is longer than `longest`.

    Solves g(tau)/tau = 0, from the acceleration alone; see `motion.near_surface`. NONE as well where the acceleration
    changes too much for the quadrature: such hops are seen in the gap itself.
    """
    a, b = 0.0, longest
    f_b, _, _ = near_surface(s, b)
    if f_b > 0.0:
        return NONE
    x = min(guess, b)
    for _ in range(MAX_ITERATIONS):
        f, u, exact = near_surface(s, x)
        if not exact:
            return NONE
        if f > 0.0:
            a = x
        else:
            b = x
        slope = (u - f) / x  # of g/tau
        x_new = x - f / slope if slope != 0.0 else a
        if not (a <= x_new <= b):
            x_new = 0.5 * (a + b)
        if abs(x_new - x) <= 2.0 * RESOLUTION * x:
            return x_new
        x = x_new
    return x


def first_release(s: Any, a: float, alpha_a: float, b: float) -> float:
    """First time in (a, b] at which the gap acceleration of a closed contact turns positive, or NONE."""
    h = (b - a) / PROBES
    t_0, f_0, t_1, f_1 = a - h, 2.0 * alpha_a, a, alpha_a
    for k in range(1, PROBES + 1):
        t_2 = b if k == PROBES else a + k * h
        f_2 = gap_acceleration(s, t_2)
        if k > 1 and f_0 < f_1 and f_2 <= f_1 and f_1 <= 0.0:
            top, f_top = summit(s, t_1, t_1 - t_0, f_0, f_1, f_2)
            if f_top > 0.0:
                return root(s, 2, t_0, f_0, top, f_top)
        if f_2 > 0.0:
            return t_1 if f_1 >= 0.0 else root(s, 2, t_1, f_1, t_2, f_2)
        t_0, f_0, t_1, f_1 = t_1, f_1, t_2, f_2
    return NONE


def summit(s: Any, t_1: float, h: float, f_0: float, f_1: float, f_2: float) -> tuple[float, float]:
    """Highest gap acceleration near the middle one of three equidistant samples h apart, by parabolas."""
    best, f_best = t_1, f_1
    for _ in range(4):
        curvature = f_0 - 2.0 * f_1 + f_2
        if curvature >= 0.0:
            break
        t = t_1 + 0.5 * h * (f_0 - f_2) / curvature
        f = gap_acceleration(s, t)
        if f > f_best:
            best, f_best = t, f
        h *= 0.25
        t_1, f_1 = t, f
        f_0 = gap_acceleration(s, t - h)
        f_2 = gap_acceleration(s, t + h)
    return best, f_best
