"""The event-driven loop of one contact that stays closed, from one slip, stop or reversal to the next, as kernels.

An arc ends at the first zero of a function g(tau) that begins at zero or above. With |g''| <= A on all of it, g stays
positive for

    h < (g' + sqrt(g'^2 + 2 A g)) / A

from any place on; steps of that length come to the first zero from below, at the end as fast as Newton's, and pass
none. Where g and g' are zero at the beginning, |g'''| <= B gives h < 3 g'' / B, and where g'' is as well,
|g''''| <= C gives h < 4 g''' / C.
"""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.arrays import doubles, indices
from lcpstep.events.arcs.motion import (
    Arc,
    belt_slip,
    bend_at,
    bends,
    look,
    pay,
    rebase,
    rise,
    set_out,
    state_at,
)
from lcpstep.events.codes import REVERSE, SLIP, STAYS_CLOSED, STICK_TANGENT
from lcpstep.events.flight.contact import ROOM
from lcpstep.events.rows.contacts import STILL
from lcpstep.kernels.course import DUE, Events
from lcpstep.kernels.quadratic import first_zero
from lcpstep.kernels.roundings import NOISE, RESOLUTION
from lcpstep.kernels.status import DONE
from lcpstep.pointers import abs, inf, max, min


class Course(Events):
    """Arcs of one contact that stays closed; s : Arc."""

    def __init__(self, s: Arc) -> None:
        super().__init__(s, ROOM)
        self.s = s

    def stage(self, goal: int) -> int:
        """Whether the motion is to begin, or goes on."""
        return self.ahead(self.s.now, self.s.tally.steps, goal) if self.s.begun else DUE

    def happen(self) -> int:
        """The state at the start of the span; a status."""
        begin(self.s)
        return DONE

    def move(self) -> int:
        """One round; a status."""
        step(self.s)
        return DONE

    @cython.ccall
    def keep_now(self) -> None:
        """Keep the state at the time reached; called from Python."""
        keep(self.s, self.s.now - self.s.t0, self.s.now)


def begin(s: Arc) -> None:
    """The state at the start of the span: the contact closes, and sticks or slides."""
    rebase(s, s.now)
    s.begun, slip, size = True, s.dz + belt_slip(s), abs(s.dz) + abs(belt_slip(s))
    note(s, STAYS_CLOSED)
    slides = abs(slip) > NOISE * size + STILL * (s.atol + s.rtol * size)
    if slides:
        s.direction = 1.0 if slip > 0.0 else -1.0
    else:
        decide(s)
    follow(s, slides)
    if s.record.keeps_events() or s.record.n_times == 0:
        keep(s, 0.0, s.now)


def note(s: Arc, kind: int) -> None:
    """Log an event at the base time; the sliding velocity is zero there."""
    s.log(s.t0, 0, 0.0, 0.0, 0.0, kind)


def decide(s: Arc) -> None:
    """Whether it sticks, or which way it will slide, at a base without sliding velocity."""
    s.direction = 0.0
    if abs(s.phi) > s.most + s.noise:
        s.direction = -1.0 if s.phi > 0.0 else 1.0


def follow(s: Arc, slides: bool) -> None:
    """The arc that begins at the base, and its end."""
    if s.direction == 0.0:
        s.dz = -belt_slip(s)
    set_out(s, slides)
    look(s, s.z, s.dz)
    s.end = first_end(s, s.t_end - s.t0)


def first_end(s: Arc, limit: float) -> float:
    """Time after the base at which the arc ends, infinite where it is not before the limit; which way into `side`."""
    here, jerk, second, third, fourth = bends(s)
    tau, sides = 0.0, 1 if s.direction != 0.0 else 2
    D = 0.0
    _, rate = rise(s, 0.0)
    while True:
        h, side = inf, 0.0
        for k in range(sides):
            way = s.direction if sides == 1 else 2.0 * k - 1.0
            start = s.room if sides == 1 else s.most + way * s.phi
            g, u = start + way * D, way * rate
            if tau == 0.0 and g == 0.0:
                clear = leave(u, way * here, way * jerk, second, third, fourth, s.noise)
            else:
                clear = first_zero(g, u, -0.5 * second)
            if clear < h:
                h, side = clear, way
        if not tau + h < limit:
            return inf
        tau += h
        if not h > RESOLUTION * tau:
            past = touch(s, tau, side * rate) if s.direction != 0.0 else 0.0
            if past == 0.0:
                s.side = side
                return tau
            tau += past
        D, rate = rise(s, tau)


def touch(s: Arc, tau: float, u: float) -> float:
    """How long the sliding velocity, zero at tau with the rate u, is below by no more than rounding; 0: it falls on.

    What a belt of constant velocity lets off slides round and round, and just reaches that velocity each time.
    """
    bend = s.direction * bend_at(s, tau)
    _, dz = state_at(s, tau)
    if u <= 0.0 and bend > 0.0 and 0.5 * u * u <= NOISE * bend * abs(dz):
        return max(-2.0 * u / bend, RESOLUTION * tau)
    return 0.0


def leave(
    u: float, bend: float, jerk: float, second: float, third: float, fourth: float, noise: float
) -> float:
    """How long a function that begins at zero stays positive; of derivatives zero to rounding the next one tells.

    As where a push that is at its least has all the friction: what begins to slide does so as the cube of time.
    """
    u = 0.0 if abs(u) <= noise else u
    h, none = first_zero(0.0, u, -0.5 * second), NOISE * second
    if u >= 0.0 and bend > none and third > 0.0:
        h = max(h, 3.0 * bend / third)
    elif u >= 0.0 and bend >= -none and jerk > 0.0 and fourth > 0.0:
        h = max(h, 4.0 * jerk / fourth)
    return h


def step(s: Arc) -> None:
    """Go on to the end of the arc, or of a step within it."""
    s.tally.steps += 1
    tau = s.now - s.t0 + s.stride
    if s.end <= tau and s.end < inf:
        t = min(s.after(s.end), s.t_end)
        keep_times(s, t, t >= s.t_end)
        turn(s, t)
        return
    t = s.t0 + tau if tau < s.t_end - s.t0 else s.t_end
    keep_times(s, t, t >= s.t_end)
    s.now = t
    if s.record.is_due(s.tally.steps):
        keep(s, t - s.t0, t)


def turn(s: Arc, t: float) -> None:
    """The end of the arc, at time t: what has stuck slides, what has slid sticks or slides on either way."""
    was, end = s.direction, s.end
    pay(s, end)
    s.z, s.dz = state_at(s, end)
    s.now = t
    rebase(s, t)
    s.dz = -belt_slip(s)
    if was == 0.0:
        s.direction = s.side
        note(s, SLIP)
    else:
        decide(s)
        if s.direction == 0.0:
            note(s, STICK_TANGENT)
        elif s.direction != was:
            note(s, REVERSE)
    follow(s, False)
    if s.record.keeps_events():
        s.record.take_back(t, s.impulse)
        keep(s, 0.0, t)


def keep(s: Arc, tau: float, t: float) -> None:
    """Keep the state at tau after the base, which is at time t, and the impulses since the one before."""
    pay(s, tau)
    state_at(s, tau)
    s.record.keep(t, s.direction, s.q, s.v, s.impulse)


def keep_times(s: Arc, stop: float, last: bool) -> None:
    """Keep the states asked for before the time `stop` (and at it, at the end of the span)."""
    while s.record.wants(stop, last):
        t = s.record.awaited()
        keep(s, t - s.t0, t)
        s.record.next_time += 1


@cython.ccall
def evaluate(s: Arc, kept: Any, coordinates: Any, times: Any, row: Any, q: Any, v: Any) -> None:
    """States at times, from the kept states before them, each that of its row; called from Python.

    coordinates : (rows, 2)   z and z' of the kept states
    """
    t, at, found_q, found_v = doubles(times), indices(row), doubles(q), doubles(v)
    kept_t, z, mode = doubles(kept.t), doubles(coordinates), doubles(kept.mode)
    n = len(times)
    with cython.nogil:
        for k in range(n):
            i = at[k]
            s.z, s.dz, s.direction = z[2 * i], z[2 * i + 1], mode[i]
            rebase(s, kept_t[i])
            set_out(s, True)
            state_at(s, t[k] - kept_t[i])
            for j in range(2):
                found_q[2 * k + j], found_v[2 * k + j] = s.q[j], s.v[j]
