"""What the forces of closed contacts hide from the comparison of two runs: errors on which both may agree.

A step of order two holds a contact, or lets it go, by the mean of its force over the step. Where the force lambda
vanishes at t_r and the contact opens at t instead, the velocities of both runs are wrong by the same impulse,

    integral of lambda from t_r to t,       lambda linear between the start, the middle and the end of the step

Friction that begins to slide is the same with mu_s lambda_N - |lambda_T| for lambda, and is less from then on by
(mu_s - mu) lambda_N. Where sliding turns about within a step, friction has the wrong sign up to then: twice its
impulse, times the part of the step before the turn. A step may also end at rest what friction cannot hold there: what
it lacks for that, times the part of the step after the turn.

A contact that stays closed moves no coordinate: its force may have vanished between the times at which it was looked
at. Where two runs differ about its impulse by more than a part of it, that counts as if it had.
"""

from __future__ import annotations

import cython

from lcpstep.pointers import abs, max, min

UNSURE = 0.25  # of an impulse: by so much two runs may differ about it


def late(one: float, first: float, second: float, length: float, opened: float, end: float) -> float:
    """Impulse by which a contact is wrong that was closed and opened at a time, or at the end not yet.

    Parameters
    ----------
    one, first, second : forces that keep it closed, half the sum of those at both ends of the step and of its halves;
        negative where it would have to be pulled
    length : of the step [s]
    opened, end : when it opened, and up to when the step is kept, since its start [s]
    """
    start, middle, last = one + first - second, first + second - one, one + second - first
    half, vanishes = 0.5 * length, gives_out(one, first, second, length, end)
    a, b = min(min(vanishes, opened), end), min(max(vanishes, opened), end)
    early, later = 0.0, 0.0
    if a < half:
        c = min(b, half)
        early = 0.5 * (c - a) * (2.0 * start + (middle - start) * (a + c) / half)
    if b > half:
        c = max(a, half)
        later = 0.5 * (b - c) * (2.0 * middle + (last - middle) * (b + c - length) / half)
    return abs(early + later)


def gives_out(one: float, first: float, second: float, length: float, end: float) -> float:
    """When the force vanishes that keeps a contact closed, or sticking; `end` where it does not. As of `late`."""
    start, middle, last = one + first - second, first + second - one, one + second - first
    half = 0.5 * length
    if start <= 0.0:
        return 0.0
    if middle <= 0.0:
        return half * start / (start - middle)
    if last <= 0.0:
        return half + half * middle / (middle - last)
    return end


def hidden(p: float, q: float) -> float:
    """What two runs differ by about the impulse of a contact that stays closed, if that is a part of it."""
    return abs(p - q) if abs(p - q) > UNSURE * min(p, q) else 0.0
