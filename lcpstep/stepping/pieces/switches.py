"""How contacts of `Located` close and open without an impact, and whether that ever ends.

Each turn of a contact is counted. A contact that goes on turning at one instant, at speeds next to nothing, is left
to `settle`; so is one that hops on beside closed contacts which feel it. Such a sequence grows ever shorter in truth,
but not below the rounding of its gaps: a particle that comes to rest on three nearly parallel planes.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import RELEASE, STAYS_CLOSED
from lcpstep.kernels.model import Model
from lcpstep.pointers import abs, max, min
from lcpstep.stepping.pieces.codes import CLOSED, GROUND, OPEN
from lcpstep.stepping.pieces.magnitudes import acceleration_terms, faint
from lcpstep.stepping.pieces.state import Plan, Work

COLLAPSE = 1e-9  # of a step: what happens as close in time as this happens at one instant
FIRST = 1e-7  # of a step: the stretch over which that is settled first; hops that no step can follow
SHORT_TOGETHER = 1e-5  # of a step: hops of coupled contacts below it are taken as one
AT_ONCE = 16  # events of one contact at one instant after which faint ones are settled,
AT_ONCE_FAST = 1000  # all but strikes of elastic contacts,
AT_ONCE_ELASTIC = 100_000  # and all


def idle(w: Work) -> None:
    """Count a round of the loop in which nothing was noted: these have an end too."""
    w.events += 1
    w.idle += 1


def count_turn(m: Model, plan: Plan, w: Work, c: int, u: float, struck: bool) -> None:
    """Note that contact c strikes, closes or opens at speed u; where that goes on for ever, the motion is settled.

    What goes on at one instant has no end if its speeds are faint. An elastic contact may be struck as often as
    masses are unlike: it is counted at one and the same time only, or where its hops are too short to be followed
    though nothing but the acceleration brings it back.
    """
    elastic = struck and m.restitution[c] == 1.0
    since = w.sigma - w.turned[c]
    if since > (0.0 if elastic else COLLAPSE * plan.h):
        w.turns[c] = 0.0
    short = (FIRST if elastic else SHORT_TOGETHER) * plan.h
    hops = since <= short and (elastic or coupled(w, c)) and abs(u) <= short * acceleration_terms(m, w, c)
    w.turned[c] = w.sigma
    w.turns[c] += 1.0
    w.hops[c] = w.hops[c] + 1.0 if hops else 0.0
    if w.hops[c] >= (AT_ONCE_FAST if elastic else AT_ONCE):
        w.stalled = max(w.stalled, short)
    if w.turns[c] < AT_ONCE:
        return
    if elastic:
        most = AT_ONCE_ELASTIC
    else:
        most = AT_ONCE if faint(plan, w, c, u) else AT_ONCE_FAST
    if w.turns[c] >= most:
        w.stalled = max(w.stalled, FIRST * plan.h)


def coupled(w: Work, c: int) -> bool:
    """Whether contact c stands beside a closed one that feels it, or beside one that opens at this very instant.

    Those that one impact throws off are noted one after another: which comes first must not matter.
    """
    found = False
    for d in range(w.n_c):
        opens = w.status[d] == OPEN and w.turned[d] == w.sigma and w.last[d] != w.sigma
        found = found or (d != c and (w.status[d] == CLOSED or opens) and w.W[c * w.n_c + d] != 0.0)
    return found


def stick(w: Work, c: int, t: float) -> None:
    """A contact stays closed from here on."""
    w.velocity[c], w.status[c] = 0.0, CLOSED
    w.closed_now += 1
    w.older[c] = w.force_now[c] = 0.0
    w.record.note(t, c, 0.0, 0.0, 0.0, STAYS_CLOSED)


def release(m: Model, plan: Plan, w: Work, c: int, t: float, after: float) -> None:
    """A closed contact opens."""
    w.status[c], w.grounded[c] = OPEN, GROUND
    w.closed_now -= 1
    w.force_now[c] = w.older[c] = 0.0
    w.gap[c], w.velocity[c] = 0.0, after
    w.record.note(t, c, 0.0, after, 0.0, RELEASE)
    count_turn(m, plan, w, c, after, False)
    w.events += 1


def release_time(w: Work, c: int, t: float, rest: float, deficit: float) -> float:
    """When the contact force vanished, between its last positive mean and the first that would be negative."""
    if not w.older[c] > 0.0:
        return t
    middle = t + 0.5 * rest
    found = w.older_time[c] + (middle - w.older_time[c]) * w.older[c] / (w.older[c] + deficit)
    return min(max(found, w.older_time[c]), t + rest)
