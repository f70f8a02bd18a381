"""Motion under constant acceleration with gaps that are linear in q, as kernels: exact, from contact to contact.

A gap is g + u tau + alpha tau^2 / 2, and its first zero is known. Gaps and speeds are carried along from event to
event, not computed from the state, so that small ones keep their digits.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import JUMP, OPEN
from lcpstep.events.parabolas.state import Mechanism
from lcpstep.events.rows.held import push_by_change
from lcpstep.events.rows.keep import keep, keep_awaited
from lcpstep.kernels.quadratic import first_zero
from lcpstep.kernels.vectors import copy, largest, product
from lcpstep.pointers import abs, max, min

LARGE = 1e-6  # of the largest coordinate: what difference of coordinates has digits enough


def fly(s: Mechanism) -> None:
    """Constant acceleration up to the next contact, or to the end of the span."""
    n_c, n_j, border = s.n_c, s.n_j, s.t_end - s.t0
    tau, meets = border, -1
    for c in range(n_c):
        if s.mode[c] == OPEN:
            root = first_zero(s.gap[n_j + c], s.velocity[n_j + c], 0.5 * s.curve[c])
            if root < tau:
                tau, meets = root, c
    t = s.t_end if meets < 0 else min(s.after(tau), s.t_end)
    s.tally.steps += 1
    s.length = tau
    pressed = 0.0
    while s.record.wants(t, meets < 0):
        wanted = s.record.awaited() - s.t0
        press(s, wanted - pressed)
        pressed = wanted
        state_at(s, wanted)
        keep_awaited(s, s.q)
    press(s, tau - pressed)
    state_at(s, tau)
    s.record.store(s.a, tau)
    for c in range(n_c):
        if s.mode[c] == OPEN:
            i, alpha = n_j + c, s.curve[c]
            s.gap[i] = max(0.0, s.gap[i] + tau * (s.velocity[i] + 0.5 * alpha * tau))
            s.velocity[i] = s.velocity[i] + alpha * tau
    rebase(s, t)
    if meets < 0:
        if s.record.is_due(s.tally.steps):
            keep(s, t, s.q)
        return
    s.gap[n_j + meets] = 0.0
    if tau == 0.0:
        s.tally.stalled += 1
    s.next = JUMP


def rebase(s: Mechanism, t: float) -> None:
    """Begin a new piece at time t with the state q, v."""
    copy(s.q0, s.q, 2 * s.n_q)
    s.start_at(t)


def state_at(s: Mechanism, tau: float) -> None:
    """State q, v at the time tau after the base."""
    a = s.a
    for j in range(s.n_q):
        s.q[j] = s.q0[j] + tau * (s.v0[j] + 0.5 * tau * a[j])
        s.v[j] = s.v0[j] + tau * a[j]


def press(s: Mechanism, tau: float) -> None:
    """Add the impulses of the forces over the time tau."""
    for i in range(s.n_r):
        k = i - s.n_j if i >= s.n_j else s.n_c + i
        s.impulse[k] = s.impulse[k] + s.multiplier[i] * tau


def synchronise(s: Mechanism) -> None:
    """Gaps and speeds of contacts just disturbed anew from q, v, where they are large enough to lose no digits so.

    Carried along over many impacts they would collect rounding, and impulses with them.
    """
    n_j, q, v = s.n_j, s.q, s.v
    length, speed = largest(q, 0.0, s.n_q), largest(v, 0.0, s.n_q)
    for c in range(s.n_c):
        if s.synchronous[c] == 0.0 and s.mode[c] == OPEN:
            s.synchronous[c] = 1.0
            g, u = product(s.R, q, n_j + c, s.n_q) + s.model.offset[c], product(s.R, v, n_j + c, s.n_q)
            if g > LARGE * length:
                s.gap[n_j + c] = g
            if abs(u) > LARGE * speed:
                s.velocity[n_j + c] = u


def polish(s: Mechanism) -> None:
    """Take from q, v what rounding has left of the gaps and speeds that are zero."""
    n_j = s.n_j
    for turn in range(4):
        x = s.q if turn < 2 else s.v
        for m in range(s.n_held):
            i = s.row[m]
            s.change[m] = -product(s.R, x, i, s.n_q)
            if turn < 2:
                s.change[m] -= s.joints.offset[i] if i < n_j else s.model.offset[i - n_j]
        push_by_change(s, x)
