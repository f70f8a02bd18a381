"""The event-driven loop of one linear degree of freedom above a flat obstacle, in closed form, as kernels.

A round is a flight up to the next contact, or rest up to the release, or neither within an interval of the scan; what
happens at contact and release is said in `modes`, and what the modes are in `contact`.
"""

from __future__ import annotations

import cython

from lcpstep.events.flight.clear import WORTH, clear_until, suspect
from lcpstep.events.flight.contact import CLOSED, JUST_RELEASED, NONE, ON_THE_SURFACE, ROOM, STRIDE, UNSEEN
from lcpstep.events.flight.keep import keep, keep_event, keep_times
from lcpstep.events.flight.modes import go_on, impact, release, settle, settle_again, turn_corner
from lcpstep.events.flight.motion import Flight, free, on_obstacle, rebase
from lcpstep.events.flight.near import SHORT, along, hop_end, is_low, low_end, stretch
from lcpstep.events.flight.rest import contact_impulse, first_release
from lcpstep.events.flight.roots import first_contact, polish
from lcpstep.kernels.course import DUE, Events
from lcpstep.kernels.status import DONE, NOT_FINITE
from lcpstep.pointers import abs, inf, max, min


class Course(Events):
    """Flights and rest of one degree of freedom; s : Flight."""

    def __init__(self, s: Flight) -> None:
        super().__init__(s, ROOM)
        self.s = s

    def stage(self, goal: int) -> int:
        """Whether the motion is to begin, or goes on."""
        return self.ahead(self.s.now, self.s.tally.steps, goal) if self.s.begun else DUE

    def happen(self) -> int:
        """The state at the start of the span; a status."""
        self.s.begun = True
        return DONE if begin(self.s) else NOT_FINITE

    def move(self) -> int:
        """One round; a status."""
        return DONE if go_further(self.s) else NOT_FINITE

    @cython.ccall
    def keep_now(self) -> None:
        """Keep the state last asked for, at the time reached; called from Python."""
        keep(self.s, self.s.now)


def go_further(s: Flight) -> bool:
    """One round; False where the motion is not finite."""
    if s.now >= s.high:
        turn_corner(s)
    if s.mode == CLOSED and s.alpha > 0.0:
        release(s, s.alpha)
    s.tally.steps += 1
    return rest(s) if s.mode == CLOSED else fly(s)


def finite(g: float, u: float, alpha: float) -> bool:
    """Whether all three are finite."""
    return g - g + u - u + alpha - alpha == 0.0


def begin(s: Flight) -> bool:
    """The state at the start of the span, which may lie on the obstacle or strike it at once."""
    t = s.now
    s.find_corners(t)
    rebase(s, t)
    g, u, alpha = free(s, 0.0)
    s.g, s.u, s.alpha = g, u, alpha
    s.q[0], s.v[0] = s.q0, s.v0
    if not finite(g, u, alpha):
        return False
    # What rounding of the state may make of rest, and rounding of the time
    small = ON_THE_SURFACE * max(1.0, abs(s.G * s.v0)) + abs(alpha) * s.margin(t)
    if s.contact and g <= ON_THE_SURFACE * max(1.0, abs(s.G * s.q0)):
        if u < -small:
            impact(s, u)
        else:
            settle(s, u if u > small else 0.0)
        s.q[0], s.v[0] = s.q0, s.v0
    if s.record.row == 0 and s.record.n_times == 0:
        keep(s, t)
    return True


def fly(s: Flight) -> bool:
    """Up to the next contact, or to the end of an interval; False where the motion is not finite."""
    a, end = s.now - s.t0, min(s.border(), s.now + STRIDE * s.scan)
    tau, u = hop_end(s, a, end - s.t0)
    if tau != NONE:
        go_to(s, tau, end)
        strike(s, min(u, 0.0))
        return True
    if is_low(s, a):
        return skim(s)
    if s.clear < inf and leap(s):
        return True
    return search(s, a, end)


def search(s: Flight, a: float, end: float) -> bool:
    """`fly` from a on by a long stride where the contact stays clear of it, and by one of the scan elsewhere."""
    short_end = min(s.border(), s.now + s.scan)
    b = end - s.t0
    g, u, alpha = free(s, b)
    is_near = suspect(s, b - a, g, u, alpha)
    if is_near and end > short_end:
        end, b = short_end, short_end - s.t0
        g, u, alpha = free(s, b)
        is_near = suspect(s, b - a, g, u, alpha)
    if not finite(g, u, alpha):
        free(s, a)
        return False
    if is_near and s.contact:
        tau = first_contact(s, a, b, g, u, alpha)
        if tau != NONE:
            return touch(s, a, tau, end)
        if s.g <= 0.0 and g < 0.0:
            # It seemed to open, by less than rounding: it is closed, for this interval at least
            s.hold = end
            settle_again(s)
            return True
    s.g, s.u, s.alpha = g, u, alpha
    s.peak = max(s.peak, abs(alpha))
    pass_end(s, end)
    return True


def touch(s: Flight, a: float, tau: float, end: float) -> bool:
    """Contact near tau, after a and by the end: an impact, or a touch without one; False where it is not finite."""
    tau, u, alpha = polish(s, tau)
    if not finite(0.0, u, alpha):
        free(s, a)
        return False
    go_to(s, tau, end)
    if -u > ON_THE_SURFACE * max(1.0, abs(s.v[0])):
        strike(s, min(u, 0.0))
    elif tau <= a:  # at the very time of the last event
        s.hold = end
        settle_again(s)
    else:
        settle(s, 0.0)
        keep_event(s)
    return True


def go_to(s: Flight, tau: float, end: float) -> None:
    """To the time tau from the base on, or to the end, past the times to keep; the state there is at hand."""
    t = min(s.after(tau), end)
    keep_times(s, t, False)
    s.now = t


def strike(s: Flight, u: float) -> None:
    """The impact at hand, which is left to a corner that it cannot be told from."""
    if s.leaves_to_corner(s.now):
        s.now, s.g, s.u = s.high, 0.0, u
    else:
        impact(s, u)


def skim(s: Flight) -> bool:
    """A stretch of a flight hardly above the obstacle, or up to its end; False where the motion is not finite."""
    border = s.border()
    h = stretch(s)
    tau, u = low_end(s, h)
    g, rise, alpha = along(s, 0, h, 1.0), along(s, 1, h, 1.0), along(s, 2, h, 1.0)
    if not finite(g, rise, alpha):
        return False
    if tau == NONE:
        t = border if h < SHORT * s.scan else s.after(h)
        keep_times(s, t, t >= s.t_end)
        s.now = t
        go_on(s, t, g, rise)
        if s.record.is_due(s.tally.steps):
            keep(s, t)
        return True
    go_to(s, tau, border)
    if tau <= UNSEEN * abs(s.now) and s.g0 == 0.0:
        s.hold = s.now + h
        settle_again(s)
    else:
        strike(s, min(u, 0.0))
    return True


def leap(s: Flight) -> bool:
    """On to where the gap is no longer certain to be open, across corners; False where that is no longer stride."""
    tau = clear_until(s, s.t_end - s.t0)
    end = min(s.t0 + tau, s.t_end)
    if end - s.now <= WORTH * s.scan or tau - tau != 0.0:
        return False
    keep_times(s, end, False)
    # A corner at the very end is still to be turned
    s.find_corners(end - 4.0 * s.margin(end))
    s.g, s.u, s.alpha = free(s, end - s.t0)
    s.peak = max(s.peak, abs(s.alpha))
    pass_end(s, end)
    return True


def pass_end(s: Flight, end: float) -> None:
    """Go on beyond the end of a scan interval; s.q, s.v hold the state there."""
    keep_times(s, end, end >= s.t_end)
    s.now = end
    kept = s.record.is_due(s.tally.steps)
    if kept or end >= s.t_end:
        free(s, end - s.t0)
    if kept:
        keep(s, end)


def rest(s: Flight) -> bool:
    """Up to the release, or to the end of the scan interval; False where alpha is not finite."""
    start, end = s.now, min(s.border(), s.now + s.scan)
    t = NONE
    if start < s.hold:
        end = min(end, s.hold)
    else:
        t = first_release(s, start, min(s.alpha, 0.0), end)
    stop = end if t == NONE else t
    if s.record.every > 0 or s.record.on_events or s.record.n_times > 0:  # or nobody asks for it
        s.impulse[0] += contact_impulse(s, start, stop)
    keep_times(s, stop, t == NONE and stop >= s.t_end)
    _, _, alpha = on_obstacle(s, stop, 0.0)
    if not finite(0.0, s.impulse[0], alpha):
        on_obstacle(s, start, 0.0)
        return False
    s.now = stop
    if t != NONE:
        release(s, JUST_RELEASED)
        return True
    s.alpha = min(alpha, 0.0)
    if s.record.is_due(s.tally.steps):
        keep(s, stop)
    return True
