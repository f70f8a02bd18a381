"""Impacts without end at one instant, as kernels: a body between two walls without clearance, or in their corner.

The laws of impact are homogeneous: where the speeds of the contacts struck return in proportion, u -> rho u, they do
so for ever. With rho < 1 the impacts that are left sum to rho / (1 - rho) of those of the last turn, and leave no
speed; with rho = 1 they have no end. The turn is looked for by comparison with the speeds at powers of two. Source of
the search: R. Brent, An improved Monte Carlo factorization algorithm, BIT 20 (1980), section 2.
"""

from __future__ import annotations

import cython

from lcpstep.events.general.ends import ACCUMULATION

if not cython.compiled:
    from lcpstep.events.general.chatter import stop
    from lcpstep.events.general.impact import apply, speed_noise
    from lcpstep.events.general.keep import log
    from lcpstep.events.general.state import Mechanism
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.pointers import abs, max

RETURNS = 2.0**-40  # relative deviation from proportion
FOR_EVER = 1.0 - 2.0**-30  # of rho: nothing is lost


def look_back(s: Mechanism) -> None:
    """Compare with the speeds of now from now on."""
    for c in range(s.n_c):
        s.contact.turn_speed[c], s.contact.turn_impulse[c] = s.contact.speed[c], 0.0
    for i in range(s.n_j):
        s.joint.turn_impulse[i] = 0.0


def recurrence(s: Mechanism) -> float:
    """The ratio rho in which the speeds of all contacts struck since have returned, or 0 if they have not."""
    most, ratio = 0.0, 0.0
    for c in range(s.n_c):
        if s.contact.turn_impulse[c] > 0.0 and abs(s.contact.turn_speed[c]) > most:
            most = abs(s.contact.turn_speed[c])
            ratio = s.contact.speed[c] / s.contact.turn_speed[c]
    if ratio > 0.0:
        for c in range(s.n_c):
            if s.contact.turn_impulse[c] > 0.0:
                error = abs(s.contact.speed[c] - ratio * s.contact.turn_speed[c])
                if error > RETURNS * ratio * most + speed_noise(s, c):
                    return 0.0
    return max(ratio, 0.0)


def sum_up(s: Mechanism, record: Record, tally: Tally, ratio: float) -> None:
    """Take the impacts that are left as one: the contacts that they strike are closed."""
    n_j, n_c, rest = s.n_j, s.n_c, ratio / (1.0 - ratio)
    s.n_held = n_j + n_c
    for i in range(n_j + n_c):
        turn = s.joint.turn_impulse[i] if i < n_j else s.contact.turn_impulse[i - n_j]
        s.row[i], s.change[i] = i, rest * turn
    before = s.t0
    for c in range(n_c):
        if s.change[n_j + c] > 0.0:
            log(s, record, tally, before, c, ACCUMULATION, s.contact.speed[c], 0.0, s.change[n_j + c])
    apply(s)
    for c in range(n_c):
        if s.change[n_j + c] > 0.0:
            s.contact.closed[c] = 1
            s.contact.since[c], s.contact.struck[c] = before - s.contact.struck[c], before
    stop(s)
