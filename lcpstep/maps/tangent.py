"""Derivative of a period's motion by its start, along event-driven runs in closed form, as kernels.

    J <- M(tau) J    free flight,    M = [S' + 2 delta S, S; -w2 S, S']      (see `events.flight.oscillator`)
    J <- D J         an impact,      D = [-r, 0; (1 + r) alpha / u-, -r]
    J <- 0           the contact closes for good: with it goes all that the motion was, for one degree of freedom

D is the saltation matrix R_x + (F+ - R_x F- - R_t) H_x / u- of G. Osorio, Complex Behavior in Impacting Systems, eqs.
3.42-3.43, written out: alpha is the gap acceleration that the free motion would have at rest on the obstacle.
"""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.arrays import doubles, indices
from lcpstep.events.codes import IMPACT, STAYS_CLOSED
from lcpstep.events.flight.motion import Flight
from lcpstep.events.flight.oscillator import fundamental
from lcpstep.events.flight.rest import alpha_at
from lcpstep.kernels.layout import COLUMNS
from lcpstep.kernels.record import Record
from lcpstep.pointers import Doubles, after, nan


def begin_tangent(J: Doubles) -> None:
    """Nothing has happened yet; J (2, 2)."""
    J[0] = J[3] = 1.0
    J[1] = J[2] = 0.0


def clear_tangent(J: Doubles, x: float) -> None:
    """J is lost, or not known."""
    J[0] = J[1] = J[2] = J[3] = x


def carry(s: Flight, J: Doubles, tau: float) -> None:
    """Free flight for a time tau."""
    S, dS, _ = fundamental(s.delta, s.w2, tau)
    for j in range(2):
        q, v = J[j], J[2 + j]
        J[j] = (dS + 2.0 * s.delta * S) * q + S * v
        J[2 + j] = -s.w2 * S * q + dS * v


def strike(s: Flight, J: Doubles, t: float, u: float) -> None:
    """An impact at time t with the gap velocity u before it; s: a flight that may be asked, and is not under way."""
    if J[0] == J[1] == J[2] == J[3] == 0.0:
        return  # at rest all was forgotten, and an obstacle whose velocity jumps strikes there with u = 0
    s.find_corners(t)
    turn = (1.0 + s.r) * alpha_at(s, t) / u
    for j in range(2):
        q, v = J[j], J[2 + j]
        J[j] = -s.r * q
        J[2 + j] = turn * q - s.r * v


def along_events(s: Flight, record: Record, J: Doubles, last: float) -> float:
    """The events noted so far, J being that at the time `last`; that of the last one; s: not under way."""
    for e in range(record.event):
        event = after(record.events, e * COLUMNS)
        t = event[0]
        if event[5] == IMPACT:
            carry(s, J, t - last)
            strike(s, J, t, event[2])
            last = t
        elif event[5] == STAYS_CLOSED:
            clear_tangent(J, 0.0)
            last = t
    return last


@cython.ccall
def along_logs(s: Flight, log: Any, counts: Any, t_start: float, t_end: float, out: Any) -> None:
    """Derivatives of periods whose impacts were recorded by any method, into out; called from Python.

    log : (m, kept, most, 2)   time and gap velocity before each impact
    counts : (m, kept, 2)   impacts and landings
    out : (m, kept, 2, 2)
    """
    impacts, counted, J = doubles(log), indices(counts), doubles(out)
    n, most = out.shape[0] * out.shape[1], log.shape[2]
    for k in range(n):
        along_log(
            s, after(impacts, 2 * most * k), counted[2 * k], most, counted[2 * k + 1] > 0, t_start, t_end,
            after(J, 4 * k),
        )  # fmt: skip


def along_log(
    s: Flight, log: Doubles, n: int, most: int, landed: bool, t_start: float, t_end: float, J: Doubles
) -> None:
    """The same of one period with n impacts, of which the first ones, at most `most`, are known."""
    begin_tangent(J)
    if landed:
        clear_tangent(J, 0.0)
    elif n > most:
        clear_tangent(J, nan)
    else:
        last = t_start
        for e in range(n):
            carry(s, J, log[2 * e] - last)
            strike(s, J, log[2 * e], log[2 * e + 1])
            last = log[2 * e]
        carry(s, J, t_end - last)
