"""The complementarity problems of `Located`, as kernels: impacts, contact forces, the end of chattering.

    impact      0 <= u+ + r u-   complementary to  p >= 0        the contacts that fire, and the closed ones that
                                                                 a chain of contacts connects with them
    contact     0 <= alpha       complementary to  lambda >= 0   all closed contacts

A contact whose next hop would be shorter than a small fraction of the step is closed: under the acceleration of the
piece, which is constant, the remaining impacts of a single contact end at T = 2 u+ / (|alpha| (1 - r)), and up to
there they have the effect of a closed contact. Sources: J. J. Moreau, Unilateral contact and dry friction in finite
freedom dynamics (1988); G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.15 and 4.2.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import call_solver, inline
from lcpstep.dense import assign
from lcpstep.dynamics import product
from lcpstep.recording import write_event
from lcpstep.stepping.located_work import (
    ACCUMULATION,
    CLOSED,
    CLOSED_NOW,
    END,
    EVENT,
    EVENTS,
    IMPACT,
    LCP_CALLS,
    OPEN,
    RELEASE,
    ROUNDING,
    SIGMA,
    STICK,
)

SHORT = 1e-7  # of a step: hops of a single contact below it are taken as one
SHORT_TOGETHER = 1e-4  # the same where other closed contacts take part
COLLAPSE = 1e-9  # of a step: impacts as close as this,
IN_A_ROW = 8  # so many of them in a row, are an inelastic collapse


@inline
def log(record: Any, count: Any, t: float, c: int, before: float, after: float, p: float, kind: int) -> None:
    """Note an event."""
    write_event(record.events[count[EVENT]], t, c, before, after, p, kind)
    count[EVENT] += 1


@inline
def solve_chosen(w: Any, W: Any, n: int, count: Any) -> bool:
    """0 <= z, W z + b >= 0 on the chosen contacts."""
    count[LCP_CALLS] += 1
    if n == 1:
        c = w.chosen[0]
        if W[c, c] > 0.0:
            w.z[0] = max(0.0, -w.b[0] / W[c, c])
            return True
    for i in range(n):
        for j in range(n):
            w.problem[i * n + j] = W[w.chosen[i], w.chosen[j]]
    return call_solver(w.solver, w.problem[: n * n].reshape((n, n)), w.b[:n], w.z[:n], w.lcp) == 0


# --- contact forces -------------------------------------------------------------------------------------------


@inline
def hold(m: Any, plan: Any, w: Any, x: Any, record: Any, place: int, t: float, count: Any) -> bool:
    """Forces of the closed contacts from w.alpha, and the acceleration with them; who needs none opens."""
    n, n_c, n_k = len(w.q), len(w.u), 0
    assign(w.a, w.free)
    for c in range(n_c):
        if w.status[c] == CLOSED:
            w.chosen[n_k] = c
            w.z[n_k] = w.multiplier[c]
            w.b[n_k] = w.alpha[c]
            n_k += 1
    if n_k == 0:
        return True
    rest = x[END] - x[SIGMA]
    W = w.WA[place] if plan.constant else w.W
    MG = w.AG[place] if plan.constant else w.MG
    if not solve_chosen(w, W, n_k, count):
        return False
    for i in range(n):
        w.a_try[i] = abs(w.free[i])
    for k in range(n_k):
        c, force = w.chosen[k], w.z[k]
        if force > 0.0:
            for i in range(n):
                w.a[i] += MG[c, i] * force
                w.a_try[i] += abs(MG[c, i] * force)
    for i in range(n):
        if abs(w.a[i]) <= ROUNDING * w.a_try[i]:
            w.a[i] = 0.0
            if plan.plain and abs(w.v[i]) <= ROUNDING * w.a_try[i] * plan.h:
                w.v[i] = 0.0
    for k in range(n_k):
        c, force = w.chosen[k], w.z[k]
        if force == 0.0:
            alpha, size = w.b[k], abs(w.b[k])
            for j in range(n_k):
                alpha += W[c, w.chosen[j]] * w.z[j]
                size += abs(W[c, w.chosen[j]] * w.z[j])
            if alpha > ROUNDING * size:
                release(w, record, count, x, c, release_time(w, c, t, rest, alpha / W[c, c]), 0.0)
                continue
        w.older[c], w.older_time[c] = force, t + 0.5 * rest
        w.multiplier[c] = force
    return True


@inline
def stick(w: Any, record: Any, count: Any, x: Any, c: int, t: float) -> None:
    """A contact stays closed from here on."""
    w.u[c], w.status[c] = 0.0, CLOSED
    x[CLOSED_NOW] += 1
    w.older[c] = w.multiplier[c] = 0.0
    log(record, count, t, c, 0.0, 0.0, 0.0, STICK)


@inline
def release_time(w: Any, c: int, t: float, rest: float, deficit: float) -> float:
    """When the contact force vanished, between its last positive mean and the first that would be negative."""
    if not w.older[c] > 0.0:
        return t
    middle = t + 0.5 * rest
    found = w.older_time[c] + (middle - w.older_time[c]) * w.older[c] / (w.older[c] + deficit)
    return min(max(found, w.older_time[c]), t + rest)


@inline
def release(w: Any, record: Any, count: Any, x: Any, c: int, t: float, after: float) -> None:
    """A closed contact opens."""
    w.status[c], w.grounded[c] = OPEN, 1
    x[CLOSED_NOW] -= 1
    w.multiplier[c] = w.older[c] = 0.0
    w.g[c], w.u[c] = 0.0, after
    log(record, count, t, c, 0.0, after, 0.0, RELEASE)
    x[EVENTS] += 1


@inline
def land(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, tau: float, count: Any) -> bool:
    """Gap velocities of closed contacts back to zero, with the normals at the end of the piece.

    A contact that would have to be pulled for that opens.
    """
    n_k = 0
    for c in range(len(w.u)):
        if w.status[c] == CLOSED:
            w.chosen[n_k] = c
            w.z[n_k] = 0.5 * tau * w.multiplier[c]
            w.b[n_k] = product(w.G, w.v, c) + w.g_t[c]
            n_k += 1
    if not solve_chosen(w, w.W, n_k, count):
        return False
    for k in range(n_k):
        c, p = w.chosen[k], w.z[k]
        w.p[c] = p
        w.impulse[c] += p
        for i in range(len(w.q)):
            w.v[i] += w.MG[c, i] * p
    for k in range(n_k):
        c = w.chosen[k]
        if w.p[c] == 0.0 and tau > 0.0:
            u, size = product(w.G, w.v, c) + w.g_t[c], abs(w.g_t[c])
            for i in range(len(w.q)):
                size += abs(w.G[c, i] * w.v[i])
            if u > ROUNDING * size:
                lost = 2.0 * u / (tau * w.W[c, c])
                force = w.multiplier[c]
                share = force / (force + lost) if force > 0.0 else 0.0
                release(w, record, count, x, c, t - tau + tau * share, u)
    return True


# --- impacts --------------------------------------------------------------------------------------------------


@inline
def strike(m: Any, plan: Any, w: Any, x: Any, record: Any, first: int, t: float, count: Any) -> int:
    """The impact of contact `first`, and of those that fire with it; how many took part, 0 if none was solved."""
    n_s = choose_struck(plan, w, first)
    if x[CLOSED_NOW] > 0:
        n_s = choose_connected(w, n_s)
    alone = n_s == 1
    for k in range(n_s):
        c = w.chosen[k]
        w.z[k] = w.b[k] = w.p[c] = 0.0
        w.plastic[c] = 0
        if w.status[c] == OPEN:
            w.plastic[c] = 1 if closes(m, plan, w, x, c, alone) else 0
            r = 0.0 if w.plastic[c] == 1 else m.restitution[c]
            w.b[k] = (1.0 + r) * w.u[c]
    if not solve_chosen(w, w.W, n_s, count):
        return 0
    jump(w, n_s)
    still = 0.0
    for k in range(n_s):
        still = max(still, ROUNDING * abs(w.g_try[w.chosen[k]]))
    for k in range(n_s):
        after_impact(m, w, x, record, w.chosen[k], w.z[k], t, still, count)
    x[EVENTS] += 1
    return n_s


@inline
def choose_struck(plan: Any, w: Any, first: int) -> int:
    """Contacts that fire now; their number."""
    w.chosen[0] = first
    w.g[first], w.grounded[first] = 0.0, 1
    n_s = 1
    for c in range(len(w.u)):
        if c != first and w.status[c] == OPEN and w.u[c] < 0.0 and w.g[c] <= plan.slack:
            w.chosen[n_s] = c
            w.g[c], w.grounded[c] = 0.0, 1
            n_s += 1
    return n_s


@inline
def choose_connected(w: Any, n_s: int) -> int:
    """Add the closed contacts that a chain of closed contacts connects with the chosen ones."""
    n_c = len(w.u)
    for c in range(n_c):
        w.p[c] = 1.0 if w.status[c] == CLOSED else 0.0  # still to be looked at
    k = 0
    while k < n_s:
        for c in range(n_c):
            if w.p[c] == 1.0 and w.W[w.chosen[k], c] != 0.0:
                w.chosen[n_s] = c
                w.p[c] = 0.0
                n_s += 1
        k += 1
    return n_s


@inline
def closes(m: Any, plan: Any, w: Any, x: Any, c: int, alone: bool) -> bool:
    """Whether the contact that fires is closed: its next hops are too short to be followed."""
    r = m.restitution[c]
    since = x[SIGMA] - w.last[c]
    w.hits[c] = w.hits[c] + 1 if w.last[c] >= 0.0 else 1
    if since > COLLAPSE * plan.h or w.last[c] < 0.0:
        w.close_hits[c] = 0
    else:
        w.close_hits[c] += 1
    w.last[c] = x[SIGMA]
    if r == 1.0 or r == 0.0:
        return False
    if w.close_hits[c] >= IN_A_ROW:
        return True
    if w.half[c] >= 0.0:
        return False
    hop = -r * w.u[c] / -w.half[c]
    if not alone:
        return hop < SHORT_TOGETHER * plan.h
    ends_in_time = hop / (1.0 - r) <= x[END] - x[SIGMA]
    return (
        ends_in_time and (hop < SHORT * plan.h or w.hits[c] > plan.many)
    ) or hop < COLLAPSE * SHORT * plan.h


@inline
def jump(w: Any, n_s: int) -> None:
    """Velocities after the impulses z of the chosen contacts; what rounding leaves of zero is zero."""
    n, n_c = len(w.q), len(w.u)
    for i in range(n):
        w.v_try[i] = abs(w.v[i])
    for k in range(n_s):
        c, p = w.chosen[k], w.z[k]
        if p > 0.0:
            for i in range(n):
                w.v[i] += w.MG[c, i] * p
                w.v_try[i] += abs(w.MG[c, i] * p)
    for i in range(n):
        if abs(w.v[i]) <= ROUNDING * w.v_try[i]:
            w.v[i] = 0.0
    for c in range(n_c):
        w.g_try[c] = w.u[c]  # before
    for k in range(n_s):
        d, p = w.chosen[k], w.z[k]
        if p > 0.0:
            for c in range(n_c):
                w.u[c] += w.W[c, d] * p


@inline
def after_impact(
    m: Any, w: Any, x: Any, record: Any, c: int, p: float, t: float, still: float, count: Any
) -> None:
    """Note the impact of a contact; the velocity it leaves with, to the last digit."""
    r, before = m.restitution[c], w.g_try[c]
    w.impulse[c] += p
    if w.status[c] == CLOSED:
        if p > 0.0:
            w.u[c] = 0.0
            log(record, count, t, c, 0.0, 0.0, p, IMPACT)
        elif w.u[c] > still:
            release(w, record, count, x, c, t, w.u[c])
        else:
            w.u[c] = 0.0
        return
    if p == 0.0:
        return
    if w.plastic[c] == 1:
        T = 0.0
        if w.half[c] < 0.0 and w.close_hits[c] < IN_A_ROW:
            T = r * before / w.half[c] / (1.0 - r)
            p += -2.0 * w.half[c] * T / w.W[c, c]
        log(record, count, t + T, c, before, 0.0, p, ACCUMULATION)
        stick(w, record, count, x, c, t + T)
        return
    w.u[c] = -r * before if r > 0.0 else 0.0
    log(record, count, t, c, before, w.u[c], p, IMPACT)
    if r == 0.0:
        stick(w, record, count, x, c, t)


@inline
def settle_rest(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, count: Any) -> bool:
    """After too many events in one step: one problem for the rest of it, plastic and without penetration.

    0 <= g + rest (u+ + rest half)  complementary to  p >= 0.
    """
    n_c, rest = len(w.u), x[END] - x[SIGMA]
    for c in range(n_c):
        w.chosen[c], w.z[c] = c, 0.0
        w.b[c] = w.g[c] / rest + w.u[c] + rest * w.half[c]
    if not solve_chosen(w, w.W, n_c, count):
        return False
    jump(w, n_c)
    for c in range(n_c):
        w.impulse[c] += w.z[c]
        if w.z[c] > 0.0:
            log(record, count, t, c, w.g_try[c], w.u[c], w.z[c], IMPACT)
        elif w.status[c] == CLOSED and w.u[c] > 0.0:
            release(w, record, count, x, c, t, w.u[c])
    return True
