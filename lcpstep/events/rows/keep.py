"""Events and states that are kept, as kernels; see `recording`."""

from __future__ import annotations

import cython

from lcpstep.events.codes import (
    LEANS,
    OPEN,
    RELEASE,
    REVERSE,
    SLIDES,
    SLIP,
    STAYS_CLOSED,
    STICK_TANGENT,
    STICKS,
)
from lcpstep.events.rows.contacts import Contacts, add_impulse, of_tangent, rubs, sliding
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.vectors import add
from lcpstep.pointers import Doubles, abs, after, max


def keep(s: Contacts, t: float, y: Doubles) -> None:
    """Keep the state y = (q, v), and the impulses since the one before."""
    for c in range(s.n_c):
        if s.owed[c] != 0.0 or s.owed[s.n_c + c] != 0.0:
            pay(s, c)
    s.record.keep(t, 0.0, y, after(y, s.n_q), s.impulse)


def keep_awaited(s: Contacts, y: Doubles) -> None:
    """The same of the state that is asked for next."""
    keep(s, s.record.awaited(), y)
    s.record.next_time += 1


def pay(s: Contacts, c: int) -> None:
    """Pay what the end of chattering has taken on account, once the impulses of a row lie in the cone with it.

    Meanwhile those of each row pay for a part of it, however short the time that they are of.
    """
    i, tangential = s.n_c + c, of_tangent(s, s.impulse, c)
    normal, friction = s.impulse[c] + s.owed[c], tangential + s.owed[i]
    noise = NOISE * (abs(tangential) + abs(s.owed[i]))
    if normal >= 0.0 and (s.n_t == 0 or abs(friction) <= s.mu_s[c] * normal + noise):
        s.impulse[c] = normal
        if s.n_t > 0:
            s.impulse[i] = friction
        s.owed[c] = s.owed[i] = 0.0
    elif normal < 0.0:
        s.owed[c], s.owed[i], s.impulse[c] = normal, friction, 0.0
        if s.n_t > 0:
            s.impulse[i] = 0.0


def put_on_account(s: Contacts) -> None:
    """Impulses by row in `multiplier` belong to contacts that are closed from here on, not to this instant."""
    for i in range(s.n_j):
        add_impulse(s, i, s.multiplier[i])
    add(s.owed, 1.0, after(s.multiplier, s.n_j), s.n_c + s.n_t)


def keep_event(s: Contacts, t: float) -> None:
    """Keep the state after an event, q and the v behind it, if these are kept; events at one time share a row."""
    if s.record.keeps_events():
        s.record.take_back(t, s.impulse)
        keep(s, t, s.q)


def tell(s: Contacts) -> bool:
    """Log the contacts whose mode is another than when last told; whether one has closed."""
    t, some = s.t0, False
    for c in range(s.n_c):
        was, now, i = s.was_mode[c], s.mode[c], s.n_j + c
        now = STICKS if now == LEANS else now
        slip = sliding(s, c)
        if (was == OPEN) != (now == OPEN):
            kind, when = RELEASE, t
            if was == OPEN:
                kind, when, some = STAYS_CLOSED, max(t, s.chatter_end[c]), True
            else:
                s.chatter_end[c] = t
            s.log(when, c, 0.0, s.velocity[i], 0.0, kind)
        elif was == SLIDES and now == STICKS:
            s.log(t, c, slip, 0.0, 0.0, STICK_TANGENT)
        elif was == STICKS and now == SLIDES:
            s.log(t, c, 0.0, slip, 0.0, SLIP)
        elif was == SLIDES and now == SLIDES and rubs(s, c) and s.direction[c] != s.was_direction[c]:
            s.log(t, c, slip, slip, 0.0, REVERSE)
        s.was_mode[c], s.was_direction[c] = now, s.direction[c]
    return some
