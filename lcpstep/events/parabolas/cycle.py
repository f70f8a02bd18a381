"""Impacts at one instant that repeat in proportion without end, as kernels: their sum. See `kernels.recurrence`."""

from __future__ import annotations

import cython

from lcpstep.events.ends import ACCUMULATION

if not cython.compiled:
    from lcpstep.events.parabolas.chatter import stop
    from lcpstep.events.parabolas.impact import apply, speed_noise
    from lcpstep.events.parabolas.state import Mechanism
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.recurrence import FAINT, FOR_EVER, left, proportion
    from lcpstep.kernels.tally import Tally
    from lcpstep.pointers import abs, min


def look_back(s: Mechanism) -> None:
    """Compare with the speeds of now from now on."""
    for c in range(s.n_c):
        s.contact.turn_speed[c], s.contact.turn_impulse[c] = s.contact.speed[c], 0.0
    for i in range(s.n_j):
        s.joint.turn_impulse[i] = 0.0


def recurrence(s: Mechanism) -> float:
    """The ratio rho in which the speeds of all contacts struck since have returned, or 0 if they have not.

    0 as well where a contact that touches would be struck before they have come to rest.
    """
    for c in range(s.n_c):
        s.contact.noise[c] = speed_noise(s, c)
    turned, before, now = s.contact.turn_impulse, s.contact.turn_speed, s.contact.speed
    ratio = proportion(turned, before, now, s.contact.noise, s.n_c)
    if 0.0 < ratio < FOR_EVER:
        for c in range(s.n_c):
            touches = s.contact.closed[c] == 0 and s.contact.gap[c] == 0.0 and s.contact.parting[c] == 0
            if touches and turned[c] == 0.0 and left(before[c], now[c], ratio) < -s.contact.noise[c]:
                return 0.0
    return ratio


def sum_up(s: Mechanism, record: Record, tally: Tally, ratio: float) -> None:
    """Take the impacts that are left as one: the contacts that they strike are closed."""
    n_j, n_c, rest = s.n_j, s.n_c, ratio / (1.0 - ratio)
    s.n_held, s.on_joints = n_j + n_c, False
    for i in range(n_j + n_c):
        turn = s.joint.turn_impulse[i] if i < n_j else s.contact.turn_impulse[i - n_j]
        s.row[i], s.change[i] = i, rest * turn
    before = s.t0
    for c in range(n_c):
        if s.change[n_j + c] > 0.0:
            s.log(record, tally, before, c, ACCUMULATION, s.contact.speed[c], 0.0, s.change[n_j + c])
    apply(s)
    for c in range(n_c):
        if s.change[n_j + c] > 0.0:
            s.contact.closed[c] = 1
            s.contact.since[c], s.contact.struck[c] = before - s.contact.struck[c], before
    stop(s)


def fades(s: Mechanism) -> bool:
    """Close the contacts that touch, if those that go on striking do so by next to nothing; whether it is so.

    Rounding adds up from impact to impact, and what is held from all sides may return its own rounding for ever.
    """
    for c in range(s.n_c):
        u = s.contact.speed[c] if s.contact.turn_impulse[c] > 0.0 else min(s.contact.speed[c], 0.0)
        if s.contact.gap[c] == 0.0 and abs(u) > FAINT * s.contact.noise[c]:
            return False
    for c in range(s.n_c):
        if s.contact.gap[c] == 0.0 and s.contact.speed[c] <= FAINT * s.contact.noise[c]:
            s.contact.closed[c], s.contact.speed[c] = 1, 0.0
    stop(s)
    return True
