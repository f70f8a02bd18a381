"""Derivative of a period's motion by its start, along event-driven runs in closed form, as kernels.

    J <- M(tau) J    free flight,    M = [S' + 2 delta S, S; -w2 S, S']      (see `events.flight.oscillator`)
    J <- D J         an impact,      D = [-r, 0; (1 + r) alpha / u-, -r]
    J <- 0           the contact closes for good: with it goes all that the motion was, for one degree of freedom

D is the saltation matrix R_x + (F+ - R_x F- - R_t) H_x / u- of G. Osorio, Complex Behavior in Impacting Systems, eqs.
3.42-3.43, written out: alpha is the gap acceleration that the free motion would have at rest on the obstacle.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.events.bookkeeping import IMPACT, STICK
from lcpstep.events.clock import find_corners
from lcpstep.events.flight.motion import DELTA, W2, R
from lcpstep.events.flight.oscillator import fundamental
from lcpstep.events.flight.rest import alpha_at


def begin_tangent(J: Any, last: Any, t: float) -> None:
    """Nothing has happened yet at time t; J (2, 2), last (1,) the time up to which J has been carried."""
    J[0, 0] = J[1, 1] = 1.0
    J[0, 1] = J[1, 0] = 0.0
    last[0] = t


def carry(s: Any, J: Any, last: Any, t: float) -> None:
    """Free flight on to time t."""
    delta, w2 = s.x[DELTA], s.x[W2]
    S, dS, _ = fundamental(delta, w2, t - last[0])
    for j in range(2):
        q, v = J[0, j], J[1, j]
        J[0, j] = (dS + 2.0 * delta * S) * q + S * v
        J[1, j] = -w2 * S * q + dS * v
    last[0] = t


def strike(s: Any, J: Any, t: float, u: float) -> None:
    """An impact at time t with the gap velocity u before it; s: a flight that may be asked, and is not under way."""
    r = s.x[R]
    find_corners(s, t)
    turn = (1.0 + r) * alpha_at(s, t) / u
    for j in range(2):
        q, v = J[0, j], J[1, j]
        J[0, j] = -r * q
        J[1, j] = turn * q - r * v


def along_events(s: Any, record: Any, events: int, J: Any, last: Any) -> None:
    """The events noted so far; s: a flight that is not under way."""
    for e in range(events):
        t, kind = record.events[e, 0], int(record.events[e, 5])
        if kind == IMPACT:
            carry(s, J, last, t)
            strike(s, J, t, record.events[e, 2])
        elif kind == STICK:
            J[0, 0] = J[0, 1] = J[1, 0] = J[1, 1] = 0.0
            last[0] = t


def along_logs(s: Any, log: Any, counts: Any, t_start: float, t_end: float, out: Any, last: Any) -> None:
    """Kernel: derivatives of periods whose impacts were recorded by any method, (m, kept, 2, 2) into out.

    log : (m, kept, most, 2) time and gap velocity before each impact;  counts : (m, kept, 2) impacts and landings
    """
    for i in range(log.shape[0]):
        for k in range(log.shape[1]):
            J = out[i, k]
            begin_tangent(J, last, t_start)
            if counts[i, k, 1] > 0:
                J[0, 0] = J[1, 1] = 0.0
            elif counts[i, k, 0] <= log.shape[2]:
                for e in range(counts[i, k, 0]):
                    carry(s, J, last, log[i, k, e, 0])
                    strike(s, J, log[i, k, e, 0], log[i, k, e, 1])
                carry(s, J, last, t_end)
            else:  # not all impacts are known
                J[0, 0] = J[0, 1] = J[1, 0] = J[1, 1] = math.nan
