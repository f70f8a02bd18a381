"""Which contacts are closed on a polynomial piece of `Located`, as kernels: one complementarity problem at its base.

Where a force vanishes it does not say whether its contact opens, the first derivative that is not zero does. There
the problem is that of the accelerations a little later: a force of order k in time, beside others that are not zero,
has the sign of its k-th derivative then.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.dynamics import gap_rates, product
from lcpstep.stepping.contact_forces import hold
from lcpstep.stepping.located_keep import keep
from lcpstep.stepping.located_work import (
    AHEAD,
    ALPHA,
    BIAS,
    CLOSED_NOW,
    EVENT,
    FREE,
    GAP_T,
    GROUND,
    GROUNDED,
    HALF,
    LEFT,
    OLDER,
    OPEN,
    Q_STAGE,
    STATUS,
    TOUCHING,
    V_STAGE,
    WHOLE,
    A,
    Q,
    V,
)
from lcpstep.stepping.polynomial import acceleration, biases
from lcpstep.stepping.scan import SOON
from lcpstep.stepping.smooth import free_acceleration, respond, within

UNDECIDED = -1.0  # in place of a time ahead


@inline
def load(m: Any, plan: Any, w: Any, x: Any, z: Any, record: Any, t: float, length: float, count: Any) -> bool:
    """Accelerations at the base of a piece, and the forces of closed contacts; who needs none opens."""
    n_c = w.num.shape[1]
    if n_c == 0:
        return True
    undecided = x[AHEAD] == UNDECIDED
    x[AHEAD] = 0.0
    if undecided:
        x[AHEAD] = SOON * length
        return look_ahead(m, plan, w, x, z, record, t, x[AHEAD], count)
    if not free_acceleration(m, w, within(plan, x, t), w.vec[Q], w.vec[V], w.vec[FREE]):
        return False
    needed = x[CLOSED_NOW] > 0 or x[TOUCHING] > 0.0
    for c in range(n_c):
        needed = needed or w.mark[GROUNDED, c] != 0
        w.num[OLDER, c] = 0.0
    if not needed:
        return True
    return decide(m, plan, w, x, record, t, w.vec[Q], w.vec[V], t, count)


def look_ahead(
    m: Any, plan: Any, w: Any, x: Any, z: Any, record: Any, t: float, ahead: float, count: Any
) -> bool:
    """The same where a contact force vanishes: which contacts are closed from now on shows a little later.

    There forces are as their first derivative that does not vanish says. The way there is that of the forces now.
    """
    if not acceleration(m, plan, w, x, t, w.vec[Q], w.vec[V], w.vec[A], count):
        return False
    q, v = z.vec[Q_STAGE], z.vec[V_STAGE]
    for i in range(len(q)):
        q[i] = w.vec[Q, i] + ahead * (w.vec[V, i] + 0.5 * ahead * w.vec[A, i])
        v[i] = w.vec[V, i] + ahead * w.vec[A, i]
    later = t + ahead
    if not free_acceleration(m, w, within(plan, x, later), q, v, w.vec[FREE]):
        return False
    x[TOUCHING] = 1.0
    for c in range(w.num.shape[1]):
        w.num[OLDER, c] = 0.0
        if w.mark[GROUNDED, c] == LEFT:
            w.mark[GROUNDED, c] = GROUND
    return decide(m, plan, w, x, record, later, q, v, t, count)


def decide(
    m: Any, plan: Any, w: Any, x: Any, record: Any, at: float, q: Any, v: Any, t: float, count: Any
) -> bool:
    """Which contacts are closed from t on, by the accelerations at a state; these without contact are at hand."""
    n_c, before = w.num.shape[1], count[EVENT]
    gap_rates(m, at, q, v, w.G, w.num[GAP_T])
    biases(m, plan, w, x, at, q, v)
    for c in range(n_c):
        w.num[ALPHA, c] = product(w.G, w.vec[FREE], c) + w.num[BIAS, c]
    if (x[CLOSED_NOW] > 0 or x[TOUCHING] > 0.0) and not plan.constant:
        respond(m, w)
    if not hold(m, plan, w, x, record, WHOLE, t, count):
        return False
    for c in range(n_c):
        w.num[HALF, c] = (
            0.5 * (product(w.G, w.vec[A], c) + w.num[BIAS, c]) if w.mark[STATUS, c] == OPEN else 0.0
        )
    if count[EVENT] > before and (record.on_events or record.every == 1):
        keep(w, record, count, t, 1.0)
    return True
