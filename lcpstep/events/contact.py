"""What the loops of one contact share, as kernels: its modes, its numbers, and what is kept of it.

With the gap g, its velocity u and the gap acceleration alpha of the free motion:

    free      g > 0, or g = 0 and u > 0, or g = u = 0 and alpha > 0
    impact    g = 0, u < 0                     -> u+ = -r u-
    closed    g = u = 0, alpha <= 0            -> the contact force keeps g = 0 until alpha turns positive

A chattering sequence is carried to its accumulation point once the error of doing so is below the tolerance. Source:
G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.16 and 4.2; A. Nordmark, P. Piiroinen, Simulation and
stability analysis of impacting systems with complete chattering, Nonlinear Dynamics 58 (2009).
"""

from __future__ import annotations

from typing import Any

from lcpstep.events.bookkeeping import EVENT, ROW, count_event, take_back
from lcpstep.events.clock import LAST_EVENT, N_CLOCK, RESOLUTION
from lcpstep.recording import LEAD, write_event, write_row

# Places in x after those of the clock: the time reached; mode; gap, its velocity and acceleration there; impulse
# since the last kept state; no release before HOLD; gap velocity and acceleration at the base, and whether that lies
# on the surface
NOW, MODE, EDGE_G, EDGE_U, EDGE_ALPHA, IMPULSE, HOLD, SPEED0, ALPHA0, ON_SURFACE = range(
    N_CLOCK, N_CLOCK + 10
)
N_CONTACT = N_CLOCK + 10
FREE, CLOSED = 0.0, 1.0  # modes
JUST_RELEASED = 1e-300  # a gap acceleration that is zero, on its way up
ON_THE_SURFACE = 64 * RESOLUTION  # a gap this small, relative to the state, is closed
UNSEEN = 4 * RESOLUTION  # of the time: a hop this short is none
NONE = -1.0  # in place of a root's time


def finite(g: float, u: float, alpha: float) -> bool:
    """Whether all three are finite."""
    return g - g + u - u + alpha - alpha == 0.0


def hop(u: float, alpha: float) -> float:
    """Duration of a hop that begins with the gap velocity u > 0, under a constant acceleration alpha < 0."""
    return 2.0 * u / -alpha


def accumulation(u: float, alpha: float, r: float) -> float:
    """Time in which the impacts accumulate after one with u+ = u, under a constant acceleration alpha < 0."""
    return 2.0 * u / (-alpha * (1.0 - r))


def sticks(u: float, alpha: float, t: float) -> bool:
    """Whether a hop would be shorter than what the time t resolves; alpha <= 0."""
    return u == 0.0 or 2.0 * u <= -alpha * UNSEEN * abs(t)


def log(s: Any, record: Any, count: Any, t: float, kind: int, before: float, after: float, p: float) -> None:
    """Note an event."""
    write_event(record.events[count[EVENT]], t, 0, before, after, p, kind)
    count_event(count, t == s.x[LAST_EVENT])
    s.x[LAST_EVENT] = t


def keep(s: Any, record: Any, count: Any, t: float) -> None:
    """Keep the state s.q, s.v at time t, and the impulse since the one before."""
    contacts = record.rows.shape[1] - LEAD - 2 * len(s.q)
    impulse = s.x[IMPULSE : IMPULSE + contacts]
    write_row(record.rows[count[ROW]], t, s.x[MODE], s.q, s.v, impulse)
    count[ROW] += 1


def keep_instead(s: Any, record: Any, count: Any) -> None:
    """The same at the time reached; events at one time share a row."""
    if take_back(record, count, s.x[NOW]) and record.rows.shape[1] > LEAD + 2 * len(s.q):
        s.x[IMPULSE] += record.rows[count[ROW], LEAD + 2 * len(s.q)]
    keep(s, record, count, s.x[NOW])
