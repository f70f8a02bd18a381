"""Which contacts are closed on a polynomial piece of `Located`, as kernels: one complementarity problem at its base.

Where a force vanishes it does not say whether its contact opens, the first derivative that is not zero does. There
the problem is that of the accelerations a little later: a force of order k in time, beside others that are not zero,
has the sign of its k-th derivative then.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import gap_rates
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import product
from lcpstep.pointers import Doubles
from lcpstep.stepping.pieces.codes import CLOSED, GROUND, LEFT, OPEN
from lcpstep.stepping.pieces.contact_forces import hold
from lcpstep.stepping.pieces.keep import keep_event
from lcpstep.stepping.pieces.polynomial import Polynomial, acceleration
from lcpstep.stepping.pieces.scan import SOON
from lcpstep.stepping.pieces.smooth import free_acceleration, gap_accelerations, gap_bias, respond
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.times import within

UNDECIDED = (
    -1.0
)  # in place of a time ahead: the next piece decides its forces a little later than at its base


def load(m: Model, plan: Plan, w: Work, z: Polynomial, t: float, length: float) -> bool:
    """Accelerations at the base of a piece, and the forces of closed contacts; who needs none opens."""
    n_c = w.n_c
    if n_c == 0:
        return True
    w.ahead = SOON * length if w.ahead == UNDECIDED else 0.0
    if w.ahead > 0.0:
        return look_ahead(m, plan, w, z, t)
    if not free_acceleration(m, w, within(w, t), w.q, w.v, w.a_free):
        return False
    needed = w.closed_now > 0 or w.touching
    for c in range(n_c):
        needed = needed or w.grounded[c] != 0
        w.older[c] = 0.0
    if not needed:
        return True
    return decide(m, plan, w, t, w.q, w.v, t)


def look_ahead(m: Model, plan: Plan, w: Work, z: Polynomial, t: float) -> bool:
    """What `load` does, where a contact force vanishes: which contacts are closed from now on shows a little later.

    There forces are as their first derivative that does not vanish says. The way there is that of the forces now.
    """
    if not acceleration(m, plan, w, t, w.q, w.v, w.a):
        return False
    q, v, ahead = z.q_stage, z.v_stage, w.ahead
    for i in range(w.n_q):
        q[i] = w.q[i] + ahead * (w.v[i] + 0.5 * ahead * w.a[i])
        v[i] = w.v[i] + ahead * w.a[i]
    later = t + ahead
    if not free_acceleration(m, w, within(w, later), q, v, w.a_free):
        return False
    w.touching = True
    for c in range(w.n_c):
        w.older[c] = 0.0
        if w.grounded[c] == LEFT and w.status[c] == OPEN:
            w.grounded[c] = GROUND
    if not decide(m, plan, w, later, q, v, t):
        return False
    for c in range(w.n_c):
        if w.grounded[c] == LEFT and w.status[c] == CLOSED:
            w.grounded[c] = GROUND
    return True


def decide(m: Model, plan: Plan, w: Work, at: float, q: Doubles, v: Doubles, t: float) -> bool:
    """Which contacts are closed from t on, by the accelerations at a state; these without contact are at hand."""
    n_c, before = w.n_c, w.record.event
    gap_rates(m, at, q, v, w.G, w.gap_t)
    gap_bias(m, w, at, q, v)
    gap_accelerations(w, w.a_free)
    if (w.closed_now > 0 or w.touching) and not plan.constant:
        respond(m, w)
    if not hold(m, plan, w, t):
        return False
    for c in range(n_c):
        w.half[c] = 0.5 * (product(w.G, w.a, c, w.n_q) + w.bias[c]) if w.status[c] == OPEN else 0.0
    if w.record.event > before:
        keep_event(w, t)
    return True
