"""Motion under constant acceleration with gaps that are linear in q, as kernels: exact, from contact to contact.

A gap is g + u tau + alpha tau^2 / 2, and its first root is known. Gaps and speeds are carried along from event to
event, not computed from the state, so that small ones keep their digits.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import largest
from lcpstep.dynamics import product
from lcpstep.events.bookkeeping import NEXT_TIME, STEP, is_due, is_wanted
from lcpstep.events.clock import T0, after
from lcpstep.events.several.held import solve_held
from lcpstep.events.several.keep import keep, keep_wanted, store_dense
from lcpstep.events.several.motion import press, rebase, state_at
from lcpstep.events.several.state import (
    CLOSED,
    CURVE,
    GAP,
    HELD_ROWS,
    JUMP,
    LENGTH,
    NEXT,
    SPEED,
    SYNCHRONOUS,
    Q,
    V,
)

LARGE = 1e-6  # of the largest coordinate: what difference of coordinates has digits enough


def fly(s: Any, record: Any, count: Any) -> None:
    """Constant acceleration up to the next contact, or to the end of the span."""
    n_c, border = len(s.G), s.plan.t_end - s.x[T0]
    tau, meets = border, -1
    for c in range(n_c):
        if s.mode[CLOSED, c] == 0:
            root = first_root(s.contact[GAP, c], s.contact[SPEED, c], s.contact[CURVE, c])
            if root < tau:
                tau, meets = root, c
    t = s.plan.t_end if meets < 0 else min(after(s.x, tau), s.plan.t_end)
    count[STEP] += 1
    s.x[LENGTH] = tau
    pressed = 0.0
    while is_wanted(record, count, t, meets < 0):
        wanted = record.times[count[NEXT_TIME]] - s.x[T0]
        press(s, wanted - pressed)
        pressed = wanted
        keep_wanted(s, record, count)
    press(s, tau - pressed)
    state_at(s, tau)
    store_dense(s, record, count)
    for c in range(n_c):
        if s.mode[CLOSED, c] == 0:
            u, alpha = s.contact[SPEED, c], s.contact[CURVE, c]
            s.contact[GAP, c] = max(0.0, s.contact[GAP, c] + tau * (u + 0.5 * alpha * tau))
            s.contact[SPEED, c] = u + alpha * tau
    rebase(s, t)
    if meets < 0:
        if is_due(record, count):
            keep(s, record, count, t)
        return
    s.contact[GAP, meets] = 0.0
    s.number[NEXT] = JUMP


def first_root(g: float, u: float, alpha: float) -> float:
    """First tau >= 0 at which g + u tau + alpha tau^2 / 2 falls through zero, or infinity; g >= 0."""
    if g <= 0.0 and u < 0.0:
        return 0.0
    square = u * u - 2.0 * alpha * g
    if square < 0.0 or (u >= 0.0 and alpha >= 0.0):
        return math.inf
    if u < 0.0:
        return 2.0 * g / (math.sqrt(square) - u)
    return (u + math.sqrt(square)) / -alpha


def synchronise(s: Any) -> None:
    """Gaps and speeds of contacts just disturbed anew from Q, V, where they are large enough to lose no digits so.

    Carried along over many impacts they would collect rounding, and impulses with them.
    """
    n_j, q, v = len(s.J), s.state[Q], s.state[V]
    length, speed = largest(q, 0.0), largest(v, 0.0)
    for c in range(len(s.G)):
        if s.contact[SYNCHRONOUS, c] == 0.0 and s.mode[CLOSED, c] == 0:
            s.contact[SYNCHRONOUS, c] = 1.0
            g, u = product(s.R, q, n_j + c) + s.model.offset[c], product(s.R, v, n_j + c)
            if g > LARGE * length:
                s.contact[GAP, c] = g
            if abs(u) > LARGE * speed:
                s.contact[SPEED, c] = u


def polish(s: Any) -> None:
    """Take from Q, V what rounding has left of the gaps and speeds that are zero."""
    k, n_j = s.number[HELD_ROWS], len(s.J)
    for x in (Q, Q, V, V):
        for m in range(k):
            i = s.row[m]
            s.change[m] = -product(s.R, s.state[x], i)
            if x == Q:
                s.change[m] -= s.joints.offset[i] if i < n_j else s.model.offset[i - n_j]
        solve_held(s, k, s.change)
        for m in range(k):
            for j in range(s.state.shape[1]):
                s.state[x, j] += s.MR[s.row[m], j] * s.change[m]
