"""What `Located` keeps of a motion, as kernels: states at steps and events, and those asked for within a piece."""

from __future__ import annotations

import cython

from lcpstep.kernels.acceleration import factor_mass
from lcpstep.kernels.dynamics import gap_rates
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import add, copy
from lcpstep.pointers import Doubles, max, min
from lcpstep.stepping.pieces.smooth import look_along, settle_state
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.times import within


def keep_times(w: Work, now: float, before: float) -> None:
    """Keep the states asked for before the given time, along the piece that begins now."""
    while w.record.awaited() < before:
        look_along(w, max(0.0, w.record.awaited() - now))
        w.record.keep_awaited(w.q_try, w.v_try, w.impulse)


def keep_now(w: Work, until: float) -> None:
    """Keep the current state for the times asked for up to the given one."""
    while w.record.awaited() <= until:
        w.record.keep_awaited(w.q, w.v, w.impulse)


def remember(w: Work) -> None:
    """Note the base of a piece, within which states will be asked for once its end is known."""
    copy(w.q_from, w.q, w.n_q)
    copy(w.v_from, w.v, w.n_q)
    copy(w.a_from, w.a, w.n_q)
    copy(w.impulse_from, w.impulse, w.n_c)


def keep_between(m: Model, plan: Plan, w: Work, base: float, tau: float, end: float) -> None:
    """Keep the states asked for within the piece that has been made, bent so that they meet the state at its end.

    Velocities along the acceleration of the base alone would be of order one.
    """
    n, n_c, share = w.n_q, w.n_c, 0.0
    for c in range(n_c):
        w.residual[c] = w.impulse[c] - w.impulse_from[c]  # which `settle_state` leaves alone
        w.impulse[c] = w.impulse_from[c]
    while w.record.awaited() < end:
        t = w.record.awaited()
        s = min(max(0.0, t - base), tau)
        r = s / tau
        for i in range(n):
            q, v, a = w.q_from[i], w.v_from[i], w.a_from[i]
            bent = w.q[i] - q - tau * (v + 0.5 * tau * a)
            w.q_try[i] = q + s * (v + 0.5 * s * a) + r * r * r * bent
            w.v_try[i] = v + s * a + r * r * (w.v[i] - v - tau * a)
        add(w.impulse, r - share, w.residual, n_c)
        share = r
        settle_state(m, plan, w, t, w.q_try)
        w.record.keep_awaited(w.q_try, w.v_try, w.impulse)
    add(w.impulse, 1.0 - share, w.residual, n_c)
    if not plan.constant:  # `settle_state` has looked elsewhere
        gap_rates(m, within(w, base + tau), w.q, w.v, w.G, w.gap_t)
        factor_mass(m, base + tau, w.q, w.v, w.M)


def keep(w: Work, t: float, jump: float, q: Doubles, v: Doubles) -> None:
    """Keep a state; states at one time share a row. Jump: 1 where the velocity may have jumped here.

    An event at the very end of a step may round to a time after it, which is that of the step's end then.
    """
    t = max(t, w.record.last_time())
    if t == w.record.last_time():
        jump = max(jump, w.record.mode[w.record.row - 1])
    w.record.take_back(t, w.impulse)
    w.record.keep(t, jump, q, v, w.impulse)


def keep_event(w: Work, t: float) -> None:
    """Keep the state after an event at time t, if these are kept."""
    if w.record.keeps_event(t):
        keep(w, t, 1.0, w.q, w.v)
