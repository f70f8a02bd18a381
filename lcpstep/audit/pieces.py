"""A finished run as an audit sees it: its motion between kept states, and which contacts are closed."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts
from lcpstep.audit import motion
from lcpstep.audit.curved import Curved
from lcpstep.audit.flat import Flat
from lcpstep.audit.windows import Windows
from lcpstep.events import EventDriven
from lcpstep.events.flight.contact import CLOSED
from lcpstep.events.flight.oscillator import oscillator_of
from lcpstep.events.flight.run import Flights
from lcpstep.events.general.run import Moved
from lcpstep.kernels.model import Model
from lcpstep.model import model
from lcpstep.stepping.interpolation import Bent
from lcpstep.trajectory import Kind, Trajectory
from lcpstep.turns import turns

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
INNER = 3  # positions within a step that is known by running it again
TOLERANCES = 10.0  # within which an event-driven run is: docs/accuracy.md
ROUNDING = 1e-13  # of positions in closed form
GROUP = 16  # windows that are looked at together first
CLOSED_GAP = 1e-12  # of the positions: a gap that is closed at the start


class Pieces:
    """The run's motion, contacts and events.

    t         (m + 1,)   ends of the pieces
    problem   gaps over windows: `flat.Flat` or `curved.Curved`
    cuts      times at which windows end
    closed    (m, n_c)   which contacts are closed in a piece
    unknown   (m,)   pieces of which the motion is not known: an impact lies within
    certain   whether the forces of closed contacts are constant, so that the run has judged them for good
    """

    def __init__(self, run: Trajectory) -> None:
        self.run, self.scene = run, run.scene
        self.m = model(self.scene)
        found = turns(self.scene)
        self.cuts = repeated(found.stops, self.scene.period, self.scene.t_span)
        self.motion, self.t, mode, error = moved(run, self.m)
        self.certain = isinstance(run.dense, Moved) and run.dense.constant
        if isinstance(self.scene.contacts, Contacts):
            assert isinstance(self.motion, motion.Polynomials)
            self.problem: Any = Curved(self.scene, self.m, self.motion, error)
        else:
            self.problem = Flat(self.scene, self.m, self.motion, np.asarray(found.stops), error)
        if mode is not None:
            self.closed = np.repeat((mode == CLOSED)[:, None], self.scene.n_c, axis=1)
        else:
            self.closed = closed_by_log(run, self.t) | closed_from_the_start(run, self.t)
        struck = run.impacts.time[run.impacts.kind == Kind.IMPACT]
        after, before = (np.searchsorted(self.t, struck, side=side) for side in ("left", "right"))
        self.unknown = np.zeros(len(self.t) - 1, dtype=bool)
        self.unknown[np.clip(after[after == before] - 1, 0, len(self.t) - 2)] = True

    def far(self, w: Windows) -> Mask:
        """Windows of flights that are certified because groups of them stay above all that the obstacle reaches."""
        far = np.zeros(len(w.a), dtype=bool)
        if (
            not isinstance(self.motion, motion.Polynomials)
            or not isinstance(self.problem, Flat)
            or self.certain
        ):
            return far
        for c in range(self.scene.n_c):
            own = np.flatnonzero((w.c == c) & ~w.closed & ~self.unknown[w.k])
            if len(own) >= 2 * GROUP:
                far[own] = self.problem.far(c, w.chosen(own), np.arange(0, len(own), GROUP))
        return far


def moved(run: Trajectory, m: Model) -> tuple[Any, Array, Array | None, tuple[Any, float]]:
    """The motion between kept states, the times of these, modes where they are known, and errors of positions."""
    dense: Any = run.dense
    method = run.method
    if isinstance(dense, Flights):
        s = dense.s
        y, w = s.q[:-1, 0].copy(), s.v[:-1, 0].copy()
        if m.frame.given:
            c = np.zeros((len(y), 1, 3))
            m.frame.sample(np.ascontiguousarray(s.t[:-1]), np.zeros(1), np.zeros(1), c)
            y, w = y + c[:, 0, 0], w + c[:, 0, 1]
        return motion.Oscillation(oscillator_of(m), s.t, y, w), s.t, s.mode[:-1], (0.0, ROUNDING)
    if isinstance(dense, Moved):
        s = dense.s
        error = (
            (TOLERANCES * method.atol, TOLERANCES * method.rtol) if by_tolerance(method) else (0.0, ROUNDING)
        )
        if dense.constant:
            return motion.parabolas(s.t, s.q, s.v, dense.F[:-1, 0]), s.t, None, (0.0, ROUNDING)
        return motion.by_steps(s.t, s.q, dense.F[:-1], s.length[:-1]), s.t, None, error
    rounding = ROUNDING * (max(np.max(np.abs(run.q)), np.max(np.abs(m.arrays["offset"]), initial=0.0)) or 1.0)
    if isinstance(dense, Bent):
        bent = motion.through(run.t, run.q, run.v, run.q[:-1, None][:, :0])
        return bent, run.t, None, (rounding + between(run, dense.jumps), 0.0)
    shares = np.arange(1, INNER + 1) / (INNER + 1)
    times = run.t[:-1, None] + np.diff(run.t)[:, None] * shares
    q, _ = run.at(times.ravel())
    inner = q.reshape(len(times), INNER, -1)
    return motion.through(run.t, run.q, run.v, inner), run.t, None, (rounding, 0.0)


def by_tolerance(method: Any) -> bool:
    """Whether the motion between kept states is known to a tolerance; steps of one size know theirs exactly."""
    return isinstance(method, EventDriven)


def between(run: Trajectory, jumps: Mask) -> Array:
    """How far the parabolas between kept states may be from the motion, (m, n_q): what their velocities miss."""
    h = np.diff(run.t)
    with np.errstate(all="ignore"):
        end = 2.0 * np.diff(run.q, axis=0) / h[:, None] - run.v[:-1]
        missed = h[:, None] * np.abs(run.v[1:] - end)
    smooth = np.where(jumps[1:, None] | ~np.isfinite(missed), 0.0, missed)
    zero = np.zeros((1, run.q.shape[1]))
    nearby = np.maximum(np.vstack([zero, smooth[:-1]]), np.vstack([smooth[1:], zero]))
    return np.asarray(0.5 * np.maximum(nearby, smooth))


def repeated(stops: Array, period: float, t_span: tuple[float, float]) -> Array:
    """The stops in the whole span, with the ends of periods."""
    if not np.isfinite(period):
        return np.asarray(stops)
    first, last = np.floor(t_span[0] / period), np.ceil(t_span[1] / period)
    turn = np.arange(first, last + 1.0) * period
    return np.unique((turn[:, None] + np.append(0.0, stops)).ravel())


def closed_by_log(run: Trajectory, t: Array) -> Mask:
    """Which contacts are closed in the pieces between times t, by the log of the run, (m, n_c)."""
    middle = 0.5 * (t[1:] + t[:-1])
    closed = np.zeros((len(middle), run.scene.n_c), dtype=bool)
    log = run.impacts
    for c in np.unique(log.contact):
        own = log[(log.contact == c) & (log.kind <= Kind.RELEASE)]
        since, last = np.inf, run.t[0]
        for time, kind, later in zip(own.time, own.kind, own.after, strict=True):
            if kind == Kind.ACCUMULATION:
                since = min(since, last)
            elif kind == Kind.STICK:
                since = min(since, time)
            elif kind == Kind.RELEASE or (later > 0.0 and since < np.inf):
                _fill(closed[:, c], middle, since, time)
                since = np.inf
            if kind == Kind.IMPACT:
                last = time
        _fill(closed[:, c], middle, since, np.inf)
    return closed


def closed_from_the_start(run: Trajectory, t: Array) -> Mask:
    """Which contacts start closed and stay so up to their first event, without a line in the log, (m, n_c)."""
    closed = np.zeros((len(t) - 1, run.scene.n_c), dtype=bool)
    looks = [float(t[0]), float(t[np.searchsorted(t, t[0], side="right")])]
    q, v = run.at(np.array(looks))
    g = np.array([run.scene.gap(x, q[k], v[k])[0] for k, x in enumerate(looks)])
    size = max(1.0, float(np.max(np.abs(run.q))))
    for c in np.flatnonzero(np.all(np.abs(g) <= CLOSED_GAP * size, axis=0)):
        own = run.impacts[run.impacts.contact == c]
        later = own.time[(own.kind == Kind.RELEASE) | (own.after > 0.0)]
        _fill(closed[:, c], 0.5 * (t[1:] + t[:-1]), -np.inf, float(later[0]) if len(later) else np.inf)
    return closed


def _fill(closed: Any, middle: Array, start: float, end: float) -> None:
    if start < end:
        closed[np.searchsorted(middle, start) : np.searchsorted(middle, end)] = True
