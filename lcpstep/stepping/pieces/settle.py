"""Events of `Located` that have no end: one plastic impact over a short stretch of time settles them.

Several coupled contacts may strike, close and open ever faster at one instant: a particle that comes to rest in a
groove, a body between walls without clearance. What is left of such a sequence is taken as one implicit step of
Moreau's, of length s,

    0 <= g / s + u + s alpha + W z   complementary to   z >= 0,      v+ = v + s a + M^-1 G^T z,      q+ = q + s v+,

which never adds energy and ends with time gone on; each further one in a step is twice as long. So a step ends after
a bounded number of events, whatever they are. Source: J. J. Moreau, Unilateral contact and dry friction in finite
freedom dynamics (1988).
"""

from __future__ import annotations

from math import pow

import cython

from lcpstep.events.codes import ACCUMULATION, IMPACT
from lcpstep.kernels.acceleration import factor_mass
from lcpstep.kernels.dynamics import gap_rates
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.status import DONE, LCP_FAILED, NOT_FINITE
from lcpstep.kernels.vectors import add
from lcpstep.pointers import abs, after, max, min
from lcpstep.stepping.pieces.chosen import solve_chosen
from lcpstep.stepping.pieces.codes import CLOSED, GROUND, INERTIA, STOPS
from lcpstep.stepping.pieces.impulses import touch
from lcpstep.stepping.pieces.keep import keep_event
from lcpstep.stepping.pieces.magnitudes import speed_terms
from lcpstep.stepping.pieces.refine import NONE
from lcpstep.stepping.pieces.smooth import (
    gap_accelerations,
    gap_bias,
    measure,
    put_on_surface,
    renew_forces,
    renew_mobility,
)
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.switches import SHORT_TOGETHER, release, stick
from lcpstep.stepping.pieces.times import within


def settle(m: Model, plan: Plan, w: Work) -> int:
    """Settle the motion from w.sigma on, with the accelerations of the piece that begins there."""
    n, rest = w.n_q, w.end - w.sigma
    span = min(rest, w.stalled * pow(2.0, w.settled)) if w.events <= plan.per_step else rest
    now = w.t_step + w.sigma
    if not meet(m, plan, w, now, span):
        return LCP_FAILED
    if matters(m, w, span > SHORT_TOGETHER * plan.h):
        w.cut += 1
    add(w.v, span, w.a_free, n)
    for c in range(w.n_c):
        p = w.z[c]
        w.impulse[c] += p
        w.pushed[c] += p
        if p > 0.0:
            add(w.v, p, after(w.MG, c * n), n)
    add(w.q, span, w.v, n)
    w.sigma = w.end if span == rest else w.sigma + span
    note(m, plan, w, now, w.t_step + w.sigma, span)
    w.stalled, w.unchanged = 0.0, False
    w.settled += 1.0
    return begin_again(m, plan, w, w.t_step + w.sigma)


def meet(m: Model, plan: Plan, w: Work, t: float, span: float) -> bool:
    """The impulses of the stretch, into w.z; gap velocities at its end without them are left in w.b."""
    n_c = w.n_c
    gap_rates(m, within(w, t), w.q, w.v, w.G, w.gap_t)
    gap_bias(m, w, t, w.q, w.v)
    if not renew_mobility(m, plan, w, t):
        return False
    gap_accelerations(w, w.a_free)
    for c in range(n_c):
        if w.gap[c] <= plan.slack:
            w.gap[c] = 0.0
        w.chosen[c], w.z[c], w.before[c] = c, 0.0, w.velocity[c]
        w.b[c] = w.gap[c] / span + w.velocity[c] + span * w.alpha[c]
    return solve_chosen(m, plan, w, INERTIA, n_c, NONE)


def matters(m: Model, w: Work, lasting: bool) -> bool:
    """Whether the stretch is told: it is lasting and there was an impact, or an elastic contact loses energy."""
    some = False
    for c in range(w.n_c):
        elastic = w.before[c] < 0.0 and m.restitution[c] == 1.0
        some = some or (w.z[c] > 0.0 and (lasting or elastic))
    return some


def note(m: Model, plan: Plan, w: Work, start: float, end: float, span: float) -> None:
    """What has become of each contact."""
    n_c = w.n_c
    for c in range(n_c):
        w.velocity[c] = w.b[c] - w.gap[c] / span
        for d in range(n_c):
            w.velocity[c] += w.W[c * w.n_c + d] * w.z[d]
    for c in range(n_c):
        closed, pressed, touches = w.status[c] == CLOSED, w.z[c] > 0.0, w.gap[c] == 0.0
        w.turns[c] = w.hops[c] = w.fall[c] = 0.0
        if pressed and not closed:
            kind = IMPACT if touches and m.restitution[c] <= STOPS else ACCUMULATION
            w.record.note(start, c, w.before[c], 0.0 if touches else w.velocity[c], w.z[c], kind)
            if touches:
                stick(w, c, end)
        elif closed and not pressed and w.velocity[c] > NOISE * speed_terms(plan, w, c):
            release(m, plan, w, c, end, w.velocity[c])
        if w.status[c] == CLOSED:
            w.gap[c] = w.velocity[c] = 0.0
        elif touches and abs(w.velocity[c]) <= NOISE * speed_terms(plan, w, c):  # at rest: the forces decide
            touch(w, c)
        else:
            w.gap[c] = max(0.0, w.gap[c] + span * w.velocity[c])
            w.grounded[c] = GROUND if w.gap[c] == 0.0 else 0


def begin_again(m: Model, plan: Plan, w: Work, t: float) -> int:
    """State, gaps and forces where the next piece begins; the states asked for in between."""
    if not plan.plain:
        if not factor_mass(m, t, w.q, w.v, w.M):
            return NOT_FINITE
        put_on_surface(m, plan, w, t, w.q)
        measure(m, w, t)
    while w.record.awaited() < t:
        left = t - w.record.awaited()
        for i in range(w.n_q):
            w.q_try[i] = w.q[i] - left * w.v[i]
        w.record.keep_awaited(w.q_try, w.v, w.impulse)
    if not renew_forces(m, plan, w, t):
        return NOT_FINITE
    keep_event(w, t)
    return DONE
