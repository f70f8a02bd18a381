"""Sequences of impacts of `Located` at one instant, as kernels: their rounding, and where they end.

A contact whose next hop would be shorter than a small fraction of the step is closed: under the acceleration of the
piece (of order 2 constant, else that of its end) the remaining impacts of a single contact end at T = 2 u+ /
(|alpha| (1 - r)), and up to there they have the effect of a closed contact. Several contacts may strike each other
to rest within no time at all, an inelastic collapse: these are closed together. Source: S. McNamara, W. Young,
Inelastic collapse and clumping in a one-dimensional granular medium, Phys. Fluids A 4 (1992).
"""

from __future__ import annotations

import cython

from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE
from lcpstep.pointers import abs
from lcpstep.stepping.pieces.codes import CLOSED, OPEN
from lcpstep.stepping.pieces.magnitudes import faint, with_terms
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.switches import AT_ONCE_FAST, COLLAPSE, SHORT_TOGETHER
from lcpstep.stepping.pieces.times import driven_by

SHORT = 1e-7  # of a step: hops of a single contact below it are taken as one
IN_A_ROW = 8  # so many impacts, each at the instant of the one before, are a collapse once faint or short
# Times the energy of a contact that comes to rest: what others that do so with it have at most
AS_SLOW = 100.0
FINE = 1e-3  # of its terms: a speed below it may be finer than velocities resolve
MANY_AT_ONCE = 64  # impacts of a contact at an instant: their rounding is no longer that of a few terms


def measure_velocities(w: Work) -> None:
    """Gap velocities of open contacts from v, where those carried from impact to impact have drifted off it.

    There are more gaps than coordinates: velocities that none of the bodies has would feed energy to impact after
    impact. Speeds finer than the velocities resolve stay, and so does rest.
    """
    for c in range(w.n_c):
        u, size = with_terms(w, w.G, c, w.v, w.gap_t[c])
        fine = NOISE if abs(u) <= FINE * size else 0.0
        if w.status[c] == OPEN and abs(u - w.velocity[c]) > fine * size:
            w.velocity[c], w.fall[c] = u, 0.0


def at_this_instant(plan: Plan, w: Work, c: int) -> bool:
    """Whether contact c has struck at the instant at hand already."""
    return w.last[c] >= 0.0 and w.sigma - w.last[c] <= COLLAPSE * plan.h


def choose_connected(w: Work, n_s: int) -> int:
    """Add the closed contacts that a chain of closed contacts connects with the chosen ones."""
    n_c = w.n_c
    for c in range(n_c):
        w.place[c] = 1 if w.status[c] == CLOSED else 0  # still to be looked at
    for k in range(n_s):
        w.place[w.chosen[k]] = 0
    k = 0
    while k < n_s:
        for c in range(n_c):
            if w.place[c] == 1 and w.W[w.chosen[k] * w.n_c + c] != 0.0:
                w.chosen[n_s] = c
                w.place[c] = 0
                n_s += 1
        k += 1
    return n_s


def choose_collapsing(plan: Plan, w: Work, first: int, n_s: int) -> int:
    """Add the contacts that collapse with the first one, to be closed with it: their number with the chosen ones.

    What is left of such a sequence, impact upon impact at one instant, ends with all of them at rest. One that is not
    brought to rest now would keep the speed of its last rebound, and go for good where nothing presses it then.
    """
    n_c = w.n_c
    for c in range(n_c):
        w.place[c] = 0
    for k in range(n_s):
        w.place[w.chosen[k]] = 1  # chosen already
    known, u, W = n_s, w.velocity[first], w.W[first * n_c + first]
    for c in range(n_c):
        row = at_this_instant(plan, w, c) and w.close_hits[c] >= IN_A_ROW
        slow = w.velocity[c] * w.velocity[c] * W <= AS_SLOW * u * u * w.W[c * n_c + c]
        if w.status[c] == OPEN and w.place[c] == 0 and row and slow:
            w.chosen[n_s] = c
            n_s += 1
    if w.closed_now > 0:
        n_s = choose_connected(w, n_s)
    for k in range(known, n_s):
        c = w.chosen[k]
        w.z[k] = w.b[k] = 0.0
        w.plastic[c] = 1 if w.status[c] == OPEN else 0
        if w.status[c] == OPEN:
            w.b[k] = w.velocity[c]
    return n_s


def note_hit(plan: Plan, w: Work, c: int) -> None:
    """Count the impact of contact c in this step, and among those at hardly any distance of each other."""
    w.hits[c] = w.hits[c] + 1 if w.last[c] >= 0.0 else 1
    w.close_hits[c] = w.close_hits[c] + 1 if at_this_instant(plan, w, c) else 0
    w.last[c] = w.sigma


def is_over(m: Model, plan: Plan, w: Work, c: int, alone: bool, t: float) -> bool:
    """Whether the contact that fires is to be closed: its next hops are too short to be followed."""
    r = m.restitution[c]
    if r == 1.0 or r == 0.0:
        return False
    hits = w.close_hits[c]
    if hits >= IN_A_ROW and (hits >= AT_ONCE_FAST or faint(plan, w, c, w.velocity[c])):
        return True
    if w.half[c] >= 0.0:
        return False
    hop = r * w.velocity[c] / w.half[c]
    if (not alone or hop > w.end - w.sigma) and unresolved(plan, w, c, hop, t):
        return True
    if not alone:
        return hop < SHORT_TOGETHER * plan.h
    ends_in_time = hop / (1.0 - r) <= w.end - w.sigma
    return (
        ends_in_time and (hop < SHORT * plan.h or w.hits[c] > plan.many)
    ) or hop < COLLAPSE * SHORT * plan.h


def unresolved(plan: Plan, w: Work, c: int, hop: float, t: float) -> bool:
    """Whether a hop is no higher than obstacles, its own or one that the body rests on, carry it in a rounding of t.

    By events of closed contacts beside it, and by ends of steps, it is cut into pieces, each of which begins with a
    gap that is wrong by so much: far from time zero such hops may be thrown up again for ever.
    """
    wrong = driven_by(w, c, t)
    for d in range(w.n_c):
        if w.status[d] == CLOSED and w.gap_t[d] != 0.0:
            share = abs(w.W[c * w.n_c + d])
            wrong += share / w.W[d * w.n_c + d] * driven_by(w, d, t) if share > 0.0 else 0.0
    return not plan.exact and 0.25 * hop * hop * -w.half[c] <= wrong
