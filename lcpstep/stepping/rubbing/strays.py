"""Rows at rest that those held keep there no longer, within a step of `Located`, as kernels.

The same as `events.contacts.loose`, whose dense output is here a step of each length that is looked at.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.contacts.loose import DRIFT, EARLIER, MORE, NEAR, straying
    from lcpstep.events.contacts.state import GUARDS
    from lcpstep.kernels.clock import NOISE, RESOLUTION
    from lcpstep.pointers import after, max, min
    from lcpstep.stepping.rubbing.found import NOWHERE, know_biases, read_guards
    from lcpstep.stepping.rubbing.strides import Strides


def find_stray(s: Strides, h: float) -> None:
    """The first row that leaves its rest within the step of size h, before the event found at `tau`, if it does so.

    As the force of its contact, in the place of the guard found; the step that is left made ends there.
    """
    end = h if s.tau == NOWHERE else s.tau
    c = straying_after(s, end, DRIFT) if end > 0.0 else -1
    if c < 0:
        return
    shown = first_beyond(s, end, DRIFT)
    place = first_beyond(s, shown, NOISE)
    s.guard, s.tau = GUARDS * c, max(0.0, place - EARLIER * (shown - place))
    s.found = s.tau / h
    s.stray[c] = MORE * max(1.0, s.stray[c])
    if s.tau > 0.0 and s.step(s.clock.t0, s.tau):
        read_guards(s, s.clock.t0 + s.tau, s.y_new)


def first_beyond(s: Strides, end: float, level: float) -> float:
    """When, up to `end`, at which it is, an acceleration comes to be beyond that share of its terms."""
    a, b = 0.0, end
    while b - a > max(NEAR * min(b, end - a), RESOLUTION * end):
        middle = 0.5 * (a + b)
        if straying_after(s, middle, level) >= 0:
            b = middle
        else:
            a = middle
    return b


def straying_after(s: Strides, tau: float, level: float) -> int:
    """The first contact of which a row has left its rest after the time tau, or -1; a step of that length is made."""
    t = s.clock.t0 + tau
    if not (s.step(s.clock.t0, tau) and read_guards(s, t, s.y_new)):
        return -1
    know_biases(s, t, s.y_new)
    return straying(s, after(s.arrival, s.n_q), level)
