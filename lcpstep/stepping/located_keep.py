"""What `Located` keeps of a motion, as kernels: states at steps and events, and those asked for within a piece."""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.dense import assign
from lcpstep.dynamics import gap_rates
from lcpstep.recording import LEAD, MODE, write_row
from lcpstep.recording import TIME as ROW_TIME
from lcpstep.stepping.located_joints import (
    take_back,
    write_joints,
)
from lcpstep.stepping.located_work import (
    A_FROM,
    CHANGE,
    EPS,
    GAP_T,
    IMPULSE,
    IMPULSE_FROM,
    LATE,
    NEXT_TIME,
    Q_FROM,
    Q_TRY,
    ROW,
    V_FROM,
    V_TRY,
    A,
    Q,
    V,
)
from lcpstep.stepping.smooth import (
    refactor,
    settle_state,
    within,
)


def keep_times(m: Any, plan: Any, w: Any, x: Any, record: Any, count: Any, now: float, before: float) -> None:
    """Keep the states asked for before the given time, along the piece that begins now."""
    while count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] < before:
        t = record.times[count[NEXT_TIME]]
        tau = max(0.0, t - now)
        for i in range(w.vec.shape[1]):
            w.vec[Q_TRY, i] = w.vec[Q, i] + tau * (w.vec[V, i] + 0.5 * tau * w.vec[A, i])
            w.vec[V_TRY, i] = w.vec[V, i] + tau * w.vec[A, i]
        write_row(record.rows[count[ROW]], t, 0.0, w.vec[Q_TRY], w.vec[V_TRY], w.num[IMPULSE])
        write_joints(w, record.rows[count[ROW]])
        count[ROW] += 1
        count[NEXT_TIME] += 1


@inline
def just_after(plan: Any, t: float) -> float:
    """Up to where times asked for are the end t of a step, but for rounding."""
    return t + LATE * plan.h + 4.0 * EPS * abs(t)


def remember(w: Any) -> None:
    """Note the base of a piece, within which states will be asked for once its end is known."""
    assign(w.vec[Q_FROM], w.vec[Q])
    assign(w.vec[V_FROM], w.vec[V])
    assign(w.vec[A_FROM], w.vec[A])
    assign(w.num[IMPULSE_FROM], w.num[IMPULSE])


def keep_between(
    m: Any, plan: Any, w: Any, x: Any, record: Any, count: Any, base: float, tau: float, end: float
) -> None:
    """Keep the states asked for within the piece that has been made, bent so that they meet the state at its end.

    Velocities along the acceleration of the base alone would be of order one.
    """
    n, n_c, share = w.vec.shape[1], w.num.shape[1], 0.0
    for c in range(n_c):
        w.num[CHANGE, c] = w.num[IMPULSE, c] - w.num[IMPULSE_FROM, c]
        w.num[IMPULSE, c] = w.num[IMPULSE_FROM, c]
    while count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] < end:
        t = record.times[count[NEXT_TIME]]
        s = min(max(0.0, t - base), tau)
        r = s / tau
        for i in range(n):
            q, v, a = w.vec[Q_FROM, i], w.vec[V_FROM, i], w.vec[A_FROM, i]
            bent = w.vec[Q, i] - q - tau * (v + 0.5 * tau * a)
            w.vec[Q_TRY, i] = q + s * (v + 0.5 * s * a) + r * r * r * bent
            w.vec[V_TRY, i] = v + s * a + r * r * (w.vec[V, i] - v - tau * a)
        for c in range(n_c):
            w.num[IMPULSE, c] += (r - share) * w.num[CHANGE, c]
        share = r
        settle_state(m, plan, w, x, t, w.vec[Q_TRY])
        write_row(record.rows[count[ROW]], t, 0.0, w.vec[Q_TRY], w.vec[V_TRY], w.num[IMPULSE])
        write_joints(w, record.rows[count[ROW]])
        count[ROW] += 1
        count[NEXT_TIME] += 1
    for c in range(n_c):
        w.num[IMPULSE, c] += (1.0 - share) * w.num[CHANGE, c]
    if not plan.constant:  # `settle_state` has looked elsewhere
        gap_rates(m, within(plan, x, base + tau), w.vec[Q], w.vec[V], w.G, w.num[GAP_T])
        refactor(m, w, base + tau)


def keep(w: Any, record: Any, count: Any, t: float, jump: float) -> None:
    """Keep the current state; states at one time share a row. Jump: 1 where the velocity may have jumped here."""
    if count[ROW] > 0 and record.rows[count[ROW] - 1, ROW_TIME] == t:
        count[ROW] -= 1
        jump = max(jump, record.rows[count[ROW], MODE])
        for c in range(w.num.shape[1]):
            w.num[IMPULSE, c] += record.rows[count[ROW], LEAD + 2 * w.vec.shape[1] + c]
        take_back(w, record.rows[count[ROW]])
    write_row(record.rows[count[ROW]], t, jump, w.vec[Q], w.vec[V], w.num[IMPULSE])
    write_joints(w, record.rows[count[ROW]])
    count[ROW] += 1
