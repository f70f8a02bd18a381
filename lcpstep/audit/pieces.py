"""A finished run as an audit sees it: its motion between kept states, and which contacts are closed."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts
from lcpstep.audit import motion, polynomials
from lcpstep.audit.anchors import Anchors
from lcpstep.audit.cones import Cones, is_known
from lcpstep.audit.curved import Curved
from lcpstep.audit.drift import begins, drift
from lcpstep.audit.flat import Flat
from lcpstep.audit.logged import close, mark
from lcpstep.audit.missed import jumped, missed
from lcpstep.audit.stepped import stepped
from lcpstep.audit.sums import missed as between_states
from lcpstep.audit.windows import Windows
from lcpstep.events import EventDriven
from lcpstep.events.arcs.run import Arcs
from lcpstep.events.flight.contact import CLOSED
from lcpstep.events.flight.oscillator import oscillator_of
from lcpstep.events.flight.run import Flights
from lcpstep.events.running import Moved
from lcpstep.kernels.model import Model
from lcpstep.kernels.states import extremes, gaps_at
from lcpstep.model import looked_at
from lcpstep.stepping.interpolation import Bent
from lcpstep.trajectory import Kind, Trajectory
from lcpstep.turns import turns

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
LOOKS = 1000  # states that the largest gap is taken from
TOLERANCES = 10.0  # within which an event-driven run is: docs/accuracy.md
ROUNDING = 1e-13  # of positions in closed form
STILL = 4e-15  # of the velocities: a gap with this rate before and after an impact stays as it is
CLOSED_GAP = 1e-12  # of the positions: a gap that is closed at the start


class Pieces:
    """The run's motion, contacts and events.

    t         (m + 1,)   ends of the pieces
    problem   gaps over windows: `flat.Flat` or `curved.Curved`
    cuts      times at which windows end
    closed    (m, n_c)   which contacts are closed in a piece
    unknown   (m,)   pieces of which the motion is not known: an impact lies within
    touched   (m + 1, n_c)   at which times a contact is at zero by what the run says
    scale     of times: the period, or the span
    largest   of all gaps, of some of the states
    certain   whether the forces of closed contacts are constant, so that the run has judged them for good, or their
        sticking and sliding has ended by bounds
    cones     guards of closed contacts with friction, or None
    """

    def __init__(self, run: Trajectory) -> None:
        self.run, self.scene = run, run.scene
        self.m = getattr(run.dense, "model", None) or looked_at(self.scene)
        found = turns(self.scene)
        self.cuts = repeated(found.stops, self.scene.period, self.scene.t_span)
        self.motion, self.t, mode, error = moved(run, self.m)
        self.certain = isinstance(run.dense, Arcs) or (isinstance(run.dense, Moved) and run.dense.constant)
        t = np.ascontiguousarray(self.t)
        names = "time", "contact", "kind", "after"
        time, contact, kind, rate = (np.array(run.impacts[x], dtype=float) for x in names)
        if mode is not None:
            self.closed = (mode == CLOSED)[:, None]  # of one contact
        else:
            if kind.any():
                still = STILL * float(np.max(np.abs(run.v), initial=0.0))
                pressed = (np.abs(run.impacts["before"]) <= still) & (np.abs(rate) <= still)
                rate[pressed] = 0.0  # by another's impact
            self.closed = closed_from_the_start(run, self.m, t)
            close(t, time, contact, kind, rate, self.closed.view(np.uint8))
        if self.motion is None:
            self.motion, off = stepped(run, self.m, self.closed, self.cuts, error[0])
            error = (error[0] + off, error[1])
        known = by_tolerance(run.method) and not self.certain and self.closed.any() and is_known(self.scene)
        self.cones = Cones(self.scene, self.motion, run.v, self.closed, error) if known else None
        gone = self.added_up()
        if isinstance(run.dense, Bent):
            error = (error[0] + between(run, begins(run.dense.jumps, self.closed)), error[1])
        if gone is not None:
            error = (error[0] + gone, error[1])
        if isinstance(self.scene.contacts, Contacts):
            assert isinstance(self.motion, polynomials.Polynomials)
            self.problem: Any = Curved(self.scene, self.m, self.motion, error, gone)
        else:
            self.problem = Flat(self.scene, self.m, self.motion, np.asarray(found.stops), error, gone)
        some = slice(None, None, max(1, len(run.t) // LOOKS))
        when, q, v = (np.ascontiguousarray(x[some]) for x in (run.t, run.q, run.v))
        self.largest = float(np.max(np.abs(extremes(self.m, when, q, v))))
        self.scale = min(self.scene.period, self.t[-1] - self.t[0])
        self.touched = np.zeros((len(self.t), self.scene.n_c), dtype=bool)
        self.unknown = np.zeros(len(self.t) - 1, dtype=bool)
        touched, unknown = (x.view(np.uint8) for x in (self.touched, self.unknown))
        mark(t, time, contact, kind, touched, unknown)
        if self.closed.any():
            self.touched[1:] |= self.closed
            self.touched[:-1] |= self.closed
        if isinstance(run.dense, Moved) and by_tolerance(run.method) and not run.dense.constant:
            self.problem.anchors = Anchors(self.t, self.touched, lambda: self.jumps, error, self.motion)

    def added_up(self) -> Array | None:
        """What steps of a given order have added up, (m, n_q); see `drift`, `missed`."""
        run, dense = self.run, self.run.dense
        if isinstance(dense, Bent):
            return drift(run, self.m, dense.jumps, self.closed, self.cuts)
        if getattr(run.method, "order", "exact") == "exact":
            return None
        return missed(run, self.m, self.motion, self.closed, self.cuts, self.jumps)

    def sharpen(self) -> bool:
        """Ask the forces along the motion how far it may be off, where that is known by tolerances alone; once."""
        anchors = self.problem.anchors
        if anchors is None or anchors.estimated is not None:
            return False
        anchors.estimated = missed(self.run, self.m, self.motion, self.closed, self.cuts, self.jumps)
        return True

    @functools.cached_property
    def jumps(self) -> Mask:
        """At which states velocities may have jumped, (m + 1,)."""
        return jumped(self.run, self.t)

    @functools.cached_property
    def events(self) -> list[Array]:
        """The times of every contact's events, between minus and plus infinity."""
        return [np.concatenate([[-np.inf], self.t[x], [np.inf]]) for x in self.touched.T]

    def to_event(self, w: Windows) -> Array:
        """How far windows reach from the nearest event of their contact, in whichever piece it lies [s]."""
        apart = np.empty(len(w.a))
        for c, times in enumerate(self.events):
            own = w.c == c
            a, b = w.a[own], w.b[own]
            after = times[np.searchsorted(times, b)] - a
            apart[own] = np.minimum(after, b - times[np.searchsorted(times, a, side="right") - 1])
        return apart


def moved(run: Trajectory, m: Model) -> tuple[Any, Array, Array | None, tuple[Any, float]]:
    """The motion between kept states, the times of these, modes where they are known, and errors of positions.

    No motion: of steps that say nothing of it, see `stepped`.
    """
    dense: Any = run.dense
    method = run.method
    if isinstance(dense, Flights):
        s = dense.s
        found = motion.Oscillation(oscillator_of(m), s.t, s.q[:, 0], s.v[:, 0], m.frame)
        return found, s.t, s.mode[:-1], (0.0, ROUNDING)
    if isinstance(dense, Moved):
        s = dense.s
        error = (
            (TOLERANCES * method.atol, TOLERANCES * method.rtol) if by_tolerance(method) else (0.0, ROUNDING)
        )
        if dense.constant:
            return polynomials.parabolas(s.t, s.q, s.v, dense.F[:-1, 0]), s.t, None, (0.0, ROUNDING)
        return polynomials.by_steps(s.t, s.q, dense.F[:-1], s.length[:-1]), s.t, None, error
    rounding = ROUNDING * (max(np.max(np.abs(run.q)), np.max(np.abs(m.arrays["offset"]), initial=0.0)) or 1.0)
    if isinstance(dense, Bent):
        bent = polynomials.through(run.t, run.q, run.v, run.q[:-1, None][:, :0])
        return bent, run.t, None, (rounding, 0.0)
    return None, run.t, None, (rounding, 0.0)


def by_tolerance(method: Any) -> bool:
    """Whether the motion between kept states is known to a tolerance; steps of one size know theirs exactly."""
    return isinstance(method, EventDriven)


def between(run: Trajectory, anew: NDArray[np.uint8]) -> Array:
    """How far the parabolas between kept states may be from the motion, (m, n_q); anew: see `begins`."""
    out = np.zeros((len(run.t) - 1, run.q.shape[1]))
    t, q, v = (np.ascontiguousarray(x) for x in (run.t, run.q, run.v))
    between_states(t, q, v, anew, out)
    return out


def repeated(stops: Array, period: float, t_span: tuple[float, float]) -> Array:
    """The stops in the whole span, with the ends of periods."""
    if not np.isfinite(period):
        return np.asarray(stops)
    first, last = np.floor(t_span[0] / period), np.ceil(t_span[1] / period)
    turn, own = np.arange(first, last + 1.0) * period, np.unique(np.append(0.0, stops))
    found = (turn[:, None] + own).ravel()
    apart = np.min(np.diff(own, append=period))  # rounding may make neighbours one, or change their order
    return found if apart > ROUNDING * np.max(np.abs(turn)) else np.unique(found)


def closed_from_the_start(run: Trajectory, m: Model, t: Array) -> Mask:
    """Which contacts start closed and stay so up to their first event, without a line in the log, (m, n_c)."""
    closed = np.zeros((len(t) - 1, run.scene.n_c), dtype=bool)
    looks = [0, int(np.searchsorted(t, t[0], side="right"))]
    g = gaps_at(m, t[looks], np.ascontiguousarray(run.q[looks]))
    size = max(1.0, float(np.max(np.abs(run.q))))
    for c in np.flatnonzero(np.all(np.abs(g) <= CLOSED_GAP * size, axis=0)):
        own = run.impacts[run.impacts.contact == c]
        later = own.time[(own.kind == Kind.RELEASE) | (own.after > 0.0)]
        _fill(closed[:, c], 0.5 * (t[1:] + t[:-1]), -np.inf, float(later[0]) if len(later) else np.inf)
    return closed


def _fill(closed: Any, middle: Array, start: float, end: float) -> None:
    if start < end:
        closed[np.searchsorted(middle, start) : np.searchsorted(middle, end)] = True
