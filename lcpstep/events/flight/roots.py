"""Where the gap of a flight closes, as kernels: roots that are bracketed before they are polished.

On an interval short enough for the gap acceleration to change its sign at most once, that sign change splits the gap
velocity into monotone parts, whose sign changes split the gap into monotone parts. So the first root is found even
where the gap dips below zero and returns within the interval (grazing). For flights that stay hardly above the
obstacle see `near`.
"""

from __future__ import annotations

import cython

from lcpstep.events.flight.contact import NONE
from lcpstep.events.flight.motion import Flight, free
from lcpstep.kernels.bracket import Bracket
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.pointers import abs

STRAIGHT = 1e-3  # of a gap root: the last step, relative to its bracket, and the change of the slope over it
GUESSES = 3  # steps of Newton's on the cubic of a first guess
COARSE = 1e-9  # of the bracket: where a gap turns it changes by the square of this
# Steps of Newton's at the end of a flight: how many, the largest, relative to flight and velocity, and the last
POLISHES, POLISH, POLISHED = 3, 1e-3, 1e-8


def first_contact(s: Flight, a: float, b: float, g_b: float, u_b: float, alpha_b: float) -> float:
    """First time in (a, b] at which the gap falls to zero, or NONE."""
    g_a, u_a, alpha_a = s.g, s.u, s.alpha
    falling = u_a < 0.0 and u_b < 0.0 and not (alpha_a > 0.0 and alpha_b < 0.0)
    if alpha_a * alpha_b < 0.0 and not falling:
        m = root(s, 2, a, alpha_a, b, alpha_b, NONE)
        g_m, u_m, _ = free(s, m)
        found = first_in_half(s, a, g_a, u_a, m, g_m, u_m)
        return found if found != NONE else first_in_half(s, m, g_m, u_m, b, g_b, u_b)
    return first_in_half(s, a, g_a, u_a, b, g_b, u_b)


def first_in_half(s: Flight, a: float, g_a: float, u_a: float, b: float, g_b: float, u_b: float) -> float:
    """The same where the gap velocity is monotone, or does not change its sign."""
    if u_a > 0.0 and u_b < 0.0 and g_a <= 0.0 and g_b <= 0.0:  # up from the obstacle and down to it again
        m = a + (b - a) * u_a / (u_a - u_b)
        g_m, u_m, _ = free(s, m)
        if g_m <= 0.0:
            m = root(s, 1, a, u_a, b, u_b, NONE)
            g_m, u_m, _ = free(s, m)
        return m if g_m <= 0.0 else gap_root(s, m, g_m, u_m, b, g_b, u_b)
    if u_a < 0.0 and u_b > 0.0 and g_a > 0.0:  # a dip, from which the gap has opened at b, or is about to
        m = root(s, 1, a, u_a, b, u_b, NONE)
        g_m, u_m, _ = free(s, m)
        return gap_root(s, a, g_a, u_a, m, g_m, u_m) if g_m <= 0.0 else NONE
    if g_a > 0.0 and g_b <= 0.0:
        return gap_root(s, a, g_a, u_a, b, g_b, u_b)
    return NONE


def gap_root(s: Flight, a: float, g_a: float, u_a: float, b: float, g_b: float, u_b: float) -> float:
    """Root of the gap between a and b, g_a g_b <= 0; the first guess from the cubic through both ends."""
    h = b - a
    bend = 3.0 * (g_b - g_a) - h * (2.0 * u_a + u_b)
    twist = h * (u_a + u_b) - 2.0 * (g_b - g_a)
    sigma = g_a / (g_a - g_b) if g_a != g_b else 0.5
    for _ in range(GUESSES):
        slope = h * u_a + sigma * (2.0 * bend + 3.0 * sigma * twist)
        if slope != 0.0:
            sigma -= (g_a + sigma * (h * u_a + sigma * (bend + sigma * twist))) / slope
    return root(s, 0, a, g_a, b, g_b, a + sigma * h)


def root(s: Flight, level: int, a: float, f_a: float, b: float, f_b: float, guess: float) -> float:
    """Root between a and b of the gap (level 0), its velocity (1) or acceleration (2); f_a f_b <= 0.

    Halley's steps for the gap, Newton's and chords for the others, from a guess that may be anything. The gap's last
    step is not evaluated any more once its own error, (|curvature| step / |slope|)^2 step, is far below what a step
    of Newton's at its end takes out (`polish`), or below rounding.
    """
    width = b - a
    s.bracket.span(a, f_a, b, f_b)
    if a < guess < b:
        s.bracket.step = guess - s.bracket.x
    while s.bracket.seek(RESOLUTION * abs(s.bracket.x) if level == 0 else COARSE * width):
        g, u, alpha = free(s, s.bracket.x)
        if level == 2:
            s.bracket.chord(alpha)
        elif level == 1:
            s.bracket.newton(u, alpha)
        elif approach(s.bracket, g, u, alpha) and s.bracket.arrive(STRAIGHT * width):
            break
    return s.bracket.x


def approach(r: Bracket, g: float, u: float, alpha: float) -> bool:
    """Take Halley's step for the gap; whether the gap is as good as straight over it."""
    step = -g / u if u != 0.0 else 0.0
    bent = abs(alpha * step)
    if 0.0 < bent <= abs(u):
        r.take(g, step - 0.5 * alpha * step * step / u)
    else:
        r.take(g, step)
    return bent <= STRAIGHT * abs(u)


def polish(s: Flight, tau: float) -> tuple[float, float, float]:
    """Steps of Newton's towards the root of the gap near tau: its time, gap velocity and acceleration there."""
    u = alpha = 0.0
    for _ in range(POLISHES):
        g, u, alpha = free(s, tau)
        if not (abs(g) < -u * POLISH * tau and abs(alpha * g) < POLISH * u * u):
            break
        past = g / u
        tau -= past * (1.0 + 0.5 * alpha * past / u)
        u -= alpha * past
        if abs(past) <= POLISHED * tau:
            break
    return tau, u, alpha
