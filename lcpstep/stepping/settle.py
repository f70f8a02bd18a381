"""Events of `Located` that have no end, as kernels: one plastic impact over a short stretch of time settles them.

Several coupled contacts may strike, close and open ever faster at one instant: a particle that comes to rest in a
groove, a body between walls without clearance. What is left of such a sequence is taken as one implicit step of
Moreau's, of length s,

    0 <= g / s + u + s alpha + W z   complementary to   z >= 0,      v+ = v + s a + M^-1 G^T z,      q+ = q + s v+,

which never adds energy and ends with time gone on; each further one in a step is twice as long. So a step ends after
a bounded number of events, whatever they are. Source: J. J. Moreau, Unilateral contact and dry friction in finite
freedom dynamics (1988).
"""

from __future__ import annotations

from typing import Any

from lcpstep.dynamics import external_force, gap_rates, product
from lcpstep.recording import write_row
from lcpstep.stepping.joint_tasks import IMPULSE as JOINT_IMPULSE
from lcpstep.stepping.located_joints import hold_joints, pass_on, turn_with_joints, write_joints
from lcpstep.stepping.located_keep import keep
from lcpstep.stepping.located_work import (
    ACCUMULATION,
    ALPHA,
    BEFORE,
    BIAS,
    CHOSEN,
    CLOSED,
    CUT,
    END,
    EVENTS,
    FALL,
    FINISHED,
    FORCE,
    FORCES,
    FREE,
    GAP,
    GAP_T,
    GROUND,
    GROUNDED,
    HOPS,
    IMPACT,
    IMPULSE,
    INERTIA,
    LCP_FAILED,
    NEXT_TIME,
    NOT_FINITE,
    Q_TRY,
    RATE,
    ROUNDING,
    ROW,
    SETTLED,
    SIGMA,
    STALLED,
    STATUS,
    TURNS,
    UNCHANGED,
    V_TRY,
    B,
    Q,
    V,
    Z,
)
from lcpstep.stepping.magnitudes import speed_terms
from lcpstep.stepping.refine import solve_chosen
from lcpstep.stepping.smooth import (
    free_acceleration,
    gap_bias,
    measure,
    put_on_surface,
    refactor,
    respond,
    within,
)
from lcpstep.stepping.switches import log, release, stick

UNTOLD = 1e-4  # of a step: contacts whose hops are shorter are closed anyhow


def endless(plan: Any, x: Any) -> bool:
    """Whether the events of this step must be settled."""
    return x[STALLED] > 0.0 or x[EVENTS] > plan.per_step


def settle(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, count: Any) -> int:
    """Settle the motion from x[SIGMA] on, with the accelerations of the piece that begins there."""
    n, rest = w.vec.shape[1], x[END] - x[SIGMA]
    span = min(rest, x[STALLED] * 2.0 ** x[SETTLED]) if x[EVENTS] <= plan.per_step else rest
    now = t + x[SIGMA]
    if not meet(m, plan, w, x, now, span, count):
        return LCP_FAILED
    count[CUT] += 1 if matters(m, w, span > UNTOLD * plan.h) else 0
    for i in range(n):
        w.vec[V, i] += span * w.vec[FREE, i]
    for c in range(w.num.shape[1]):
        p = w.num[Z, c]
        w.num[IMPULSE, c] += p
        if p > 0.0:
            pass_on(w, c, p, JOINT_IMPULSE)
            for i in range(n):
                w.vec[V, i] += w.MG[c, i] * p
    hold_joints(w, span)
    for i in range(n):
        w.vec[Q, i] += span * w.vec[V, i]
    x[SIGMA] = x[END] if span == rest else x[SIGMA] + span
    note(m, plan, w, x, record, now, t + x[SIGMA], span, count)
    x[STALLED], x[UNCHANGED] = 0.0, 0.0
    x[SETTLED] += 1.0
    return begin_again(m, plan, w, x, record, t + x[SIGMA], count)


def meet(m: Any, plan: Any, w: Any, x: Any, t: float, span: float, count: Any) -> bool:
    """The impulses of the stretch, into w.num[Z]; gap velocities at its end without them are left in w.num[B]."""
    n_c = w.num.shape[1]
    gap_rates(m, within(plan, x, t), w.vec[Q], w.vec[V], w.G, w.num[GAP_T])
    gap_bias(m, w, within(plan, x, t), w.vec[Q], w.vec[V])
    if not plan.constant:
        if not refactor(m, w, t):
            return False
        respond(m, w)
    for c in range(n_c):
        w.num[ALPHA, c] = product(w.G, w.vec[FREE], c) + w.num[BIAS, c]
        if w.num[GAP, c] <= plan.slack:
            w.num[GAP, c] = 0.0
        w.mark[CHOSEN, c], w.num[Z, c], w.num[BEFORE, c] = c, 0.0, w.num[RATE, c]
        w.num[B, c] = w.num[GAP, c] / span + w.num[RATE, c] + span * w.num[ALPHA, c]
    return solve_chosen(m, plan, w, w.W, INERTIA, n_c, count)


def matters(m: Any, w: Any, long: bool) -> bool:
    """Whether the stretch is told: it is long and there was an impact, or an elastic contact loses energy."""
    some = False
    for c in range(w.num.shape[1]):
        elastic = w.num[BEFORE, c] < 0.0 and m.restitution[c] == 1.0
        some = some or (w.num[Z, c] > 0.0 and (long or elastic))
    return some


def note(
    m: Any, plan: Any, w: Any, x: Any, record: Any, start: float, end: float, span: float, count: Any
) -> None:
    """What has become of each contact."""
    n_c = w.num.shape[1]
    for c in range(n_c):
        w.num[RATE, c] = w.num[B, c] - w.num[GAP, c] / span
        for d in range(n_c):
            w.num[RATE, c] += w.W[c, d] * w.num[Z, d]
    for c in range(n_c):
        closed, pressed, touches = w.mark[STATUS, c] == CLOSED, w.num[Z, c] > 0.0, w.num[GAP, c] == 0.0
        w.num[TURNS, c] = w.num[HOPS, c] = w.num[FALL, c] = 0.0
        if pressed and not closed:
            kind = IMPACT if touches and m.restitution[c] == 0.0 else ACCUMULATION
            after = 0.0 if touches else w.num[RATE, c]
            log(record, count, start, c, w.num[BEFORE, c], after, w.num[Z, c], kind)
            if touches:
                stick(w, record, count, x, c, end)
        elif closed and not pressed and w.num[RATE, c] > ROUNDING * speed_terms(plan, w, c):
            release(m, plan, w, record, count, x, c, end, w.num[RATE, c])
        if w.mark[STATUS, c] == CLOSED:
            w.num[GAP, c] = w.num[RATE, c] = 0.0
        else:
            w.num[GAP, c] = max(0.0, w.num[GAP, c] + span * w.num[RATE, c])
            w.mark[GROUNDED, c] = GROUND if w.num[GAP, c] == 0.0 else 0


def begin_again(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, count: Any) -> int:
    """State, gaps and forces where the next piece begins; the states asked for in between."""
    if not plan.plain:
        if not refactor(m, w, t):
            return NOT_FINITE
        put_on_surface(m, plan, w, t)
        turn_with_joints(w, within(plan, x, t))
        measure(m, plan, w, x, t)
    while count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] < t:
        at = record.times[count[NEXT_TIME]]
        for i in range(w.vec.shape[1]):
            w.vec[Q_TRY, i] = w.vec[Q, i] - (t - at) * w.vec[V, i]
            w.vec[V_TRY, i] = w.vec[V, i]
        write_row(record.rows[count[ROW]], at, 0.0, w.vec[Q_TRY], w.vec[V_TRY], w.num[IMPULSE])
        write_joints(w, record.rows[count[ROW]])
        count[ROW] += 1
        count[NEXT_TIME] += 1
    if plan.trapezoidal and not plan.steady:
        external_force(m, within(plan, x, t), w.vec[Q], w.vec[V], w.vec[FORCE])
        count[FORCES] += 1
    elif not plan.trapezoidal:
        if not free_acceleration(m, w, within(plan, x, t), w.vec[Q], w.vec[V], w.vec[FREE]):
            return NOT_FINITE
        count[FORCES] += 1
    if record.on_events or record.every == 1:
        keep(w, record, count, t, 1.0)
    return FINISHED
