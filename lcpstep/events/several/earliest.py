"""Which of several contacts closes, or opens, first, as kernels.

Gaps are looked at on the dense output of a Runge-Kutta step: on an interval short enough for a gap acceleration to
change its sign at most once, that change splits the gap velocity into monotone parts, whose changes of sign split the
gap into monotone parts; so a gap that dips below zero and returns is found. A closed contact opens where its
multiplier turns negative. Source of the polishing: Newton's method safeguarded by bisection, W. Press et al.,
Numerical Recipes, section 9.4.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import largest, split
from lcpstep.dynamics import gaps, product
from lcpstep.events.clock import RESOLUTION, T0, inside
from lcpstep.events.dop853 import interpolate
from lcpstep.events.several.equations import biases, constraint_rows
from lcpstep.events.several.held import note, right_hand_side
from lcpstep.events.several.impact import speed_noise
from lcpstep.events.several.state import (
    ACCELERATION,
    CLOSED,
    CURVE,
    FORCE,
    GAP,
    HELD,
    HELD_ROWS,
    LEFT_CURVE,
    LEFT_GAP,
    LEFT_MULTIPLIER,
    LEFT_SPEED,
    LENGTH,
    MULTIPLIER,
    NOISE,
    RATE,
    SOUGHT,
    SPEED,
    Q,
    V,
)

MEETS, OPENS, NEVER_LEFT = range(3)  # what a contact does
NONE = -1.0  # in place of a root's time
MAX_ITERATIONS = 100


def first_event(s: Any, a: float, b: float) -> float:
    """First contact that closes or opens in (a, b], or NONE.

    The left end is in the LEFT rows, the right end has just been observed and is kept in the first rows of `seen`;
    which contact and what it does (MEETS, OPENS, NEVER_LEFT) into the last.
    """
    seen, found, noise = s.seen, NONE, multiplier_noise(s)
    for c in range(len(s.G)):  # what is observed now will be overwritten
        for k in range(4):
            seen[k, c] = s.contact[GAP + k, c]
    for c in range(len(s.G)):
        tau, kind = NONE, MEETS
        if s.mode[CLOSED, c] == 1:
            left, right = s.contact[LEFT_MULTIPLIER, c], seen[MULTIPLIER, c]
            if right < -noise and s.contact[HELD, c] < s.x[T0] + b:
                kind = OPENS
                seek(s, float(MULTIPLIER))
                tau = a if left <= 0.0 else root(s, c, a, left, b, right)
        else:
            left_end = (s.contact[LEFT_GAP, c], s.contact[LEFT_SPEED, c], s.contact[LEFT_CURVE, c])
            right_end = (seen[GAP, c], seen[SPEED, c], seen[CURVE, c])
            if left_end[0] <= 0.0 and left_end[1] < -speed_noise(s, c):  # met just where the last event was
                tau = a
            else:
                tau = first_contact(s, c, a, b, left_end, right_end)
            if tau == NONE and left_end[0] <= 0.0 and right_end[0] < 0.0:
                tau, kind = a, NEVER_LEFT
        if tau != NONE and (found == NONE or tau < found):
            found, seen[4, 0], seen[4, 1] = tau, float(c), float(kind)
    return found


def first_contact(s: Any, c: int, a: float, b: float, left: Any, right: Any) -> float:
    """First time in (a, b] at which the gap of contact c falls to zero, or NONE.

    left, right : gap, velocity and acceleration at a and b.
    """
    middle, at_middle = b, right
    if left[2] * right[2] < 0.0 and (left[1] < 0.0 or right[1] > 0.0 or right[0] <= 0.0):
        seek(s, float(CURVE))
        middle = root(s, c, a, left[2], b, right[2])
        observe(s, middle)
        at_middle = (s.contact[GAP, c], s.contact[SPEED, c], s.contact[CURVE, c])
    found = first_in_half(s, c, a, middle, left, at_middle)
    if found == NONE and middle < b:
        found = first_in_half(s, c, middle, b, at_middle, right)
    return found


def first_in_half(s: Any, c: int, a: float, b: float, left: Any, right: Any) -> float:
    """The same where the gap velocity is monotone."""
    if left[1] * right[1] < 0.0:
        if left[1] > 0.0 and right[0] > 0.0:
            return NONE
        seek(s, float(SPEED))
        middle = root(s, c, a, left[1], b, right[1])
        observe(s, middle)
        g = s.contact[GAP, c]
        seek(s, float(GAP))
        if left[1] < 0.0 and left[0] > 0.0 and g <= 0.0:
            return root(s, c, a, left[0], middle, g)
        if left[1] > 0.0:
            return middle if g <= 0.0 else root(s, c, middle, g, b, right[0])
        return NONE
    if left[0] > 0.0 and right[0] <= 0.0:
        seek(s, float(GAP))
        return root(s, c, a, left[0], b, right[0])
    return NONE


def seek(s: Any, level: float) -> None:
    """Make `root` look for a root of the gap (level GAP), the velocity, the acceleration or the multiplier.

    Numba compiles a function anew for every whole number that it is called with, but not for every float.
    """
    s.number[SOUGHT] = int(level)


def root(s: Any, c: int, a: float, f_a: float, b: float, f_b: float) -> float:
    """Root between a and b of what `seek` has chosen, for contact c; f_a f_b <= 0."""
    level = s.number[SOUGHT]
    if f_a == 0.0:
        return a
    x, f_x = (b, f_b) if abs(f_b) < abs(f_a) else (a, f_a)
    slope = (f_b - f_a) / (b - a)
    before = b - a
    for _ in range(MAX_ITERATIONS):
        if f_x == 0.0:
            return x
        x_new = x - f_x / slope if slope != 0.0 else a
        if not (a < x_new < b) or abs(x_new - x) > 0.5 * abs(before):
            x_new = 0.5 * (a + b)
        before = x_new - x
        x_old, f_old, x = x, f_x, x_new
        observe(s, x)
        f_x = s.contact[level, c]
        if (f_x > 0.0) == (f_a > 0.0):
            a, f_a = x, f_x
        else:
            b = x
        slope = s.contact[level + 1, c] if level < CURVE else (f_x - f_old) / (x - x_old)
        if abs(before) <= 2.0 * RESOLUTION * abs(x) or b - a <= 2.0 * RESOLUTION * abs(x):
            return x
    return x


def observe(s: Any, tau: float) -> bool:
    """Gaps, speeds, gap accelerations and multipliers at tau after the base, from the dense output."""
    t = s.x[T0] + tau
    q, v, a = s.state[Q], s.state[V], s.state[ACCELERATION]
    interpolate(s.w.F, s.w.y, tau / s.x[LENGTH], s.w.y_stage)
    split(s.w.y_stage, q, v)
    if not right_hand_side(s, t, s.w.y_stage, s.dy):
        return False
    n = len(q)
    for i in range(n):
        a[i] = s.dy[n + i]
    if len(s.G) > 0:
        gaps(s.model, t, q, v, s.contact[GAP])
        biases(s, s.model, s.G, s.contact, inside(s.x, t), q, v)
        constraint_rows(s, t, q, v)
    note(s, a)
    finite = True
    for c in range(len(s.G)):
        u = product(s.G, v, c) + s.contact[RATE, c]
        s.contact[SPEED, c] = u
        finite = finite and math.isfinite(s.contact[GAP, c] + u + s.contact[CURVE, c])
    return finite


def remember(s: Any) -> None:
    """What was observed last is the left end of the next interval."""
    for c in range(len(s.G)):
        for k in range(4):
            s.contact[LEFT_GAP + k, c] = s.contact[GAP + k, c]


def multiplier_noise(s: Any) -> float:
    """Rounding of a multiplier."""
    return NOISE * largest(s.state[FORCE], largest(s.held[: s.number[HELD_ROWS]], 0.0))
