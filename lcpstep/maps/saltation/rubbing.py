"""Derivative of a motion with contacts, friction and joints by its initial state: variations and saltation matrices.

Between events J' = F_x J, F the field of the modes at hand. Where the guard H of an event falls through zero, and the
state jumps to x+ = R(t, x-),

    D = R_x + (F+ - R_x F- - R_t) H_x / (H_x F- + H_t):

at an impact H is the gap, and R the law of impact with the contacts that stick and slide in it; where one begins to
stick, or slides the other way, H is its sliding velocity and R = x, so that D takes what is left of sliding: a
dead-beat multiplier, zero to rounding. A release and a slip at the edge of the friction cone are continuous, F+ = F-
and D = 1. Where infinitely many hops end, and at the start, deviations from the surfaces held are lost along the
forces that hold them. Source: R. Leine, H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems
(Springer 2004), chapter 7; of impacts G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.42-3.43.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.errors import LcpStepError
from lcpstep.events.codes import OPEN, RELATIVE_STEP, SLIDES, STICKS
from lcpstep.events.contacts import point
from lcpstep.events.contacts.run import start
from lcpstep.events.contacts.smooth import Smooth
from lcpstep.lengths import ASIDE, derivative, lengths, sizes
from lcpstep.maps.saltation.blow import Blow
from lcpstep.maps.saltation.finished import closed_at_once, with_friction
from lcpstep.maps.saltation.lost import lost
from lcpstep.maps.saltation.variations import Variations
from lcpstep.refusals import refused
from lcpstep.trajectory import Kind, Status, Trajectory

Array = NDArray[np.float64]
CONTINUOUS = 1e-9  # difference of fields that is none, relative to their size
STEP = 1e-4  # of differences of guards, relative
SAME = 1e-12  # times that are one, relative


@dataclass(frozen=True, eq=False)
class Piece:
    """Motion from the state x at t on, to `end` where it is x_end, with its modes; J: its derivative.

    It goes on over corners of the scene; from `smooth` on, where it is x_smooth, there is none.
    """

    t: float
    x: Array
    smooth: float
    x_smooth: Array
    end: float
    x_end: Array
    mode: Any
    direction: Array
    J: Array


class Walk:
    """Along the events of a run of `EventDriven` that has kept its states at them."""

    def __init__(self, run: Trajectory) -> None:
        self.run, self.scene, self.n = run, with_friction(run.scene), run.scene.n_q
        self.s = start(self.scene, Smooth, run.method.rtol, run.method.atol)
        self.scale, self.sizes = max(float(np.max(np.abs(run.t))), 1e-300), sizes(run)
        self.flow = Variations(self.s, np.minimum(self.sizes, 1.0))
        self.log = closed_at_once(run)

    def factors(self) -> list[Array]:
        """Matrices to be multiplied from the left one by one: flows and saltations in the order of time."""
        if self.run.status != Status.DONE:
            raise LcpStepError(f"the motion ended early: {self.run.message}")
        piece = self.begin()
        result = [self.lost(piece), piece.J]
        for time in self.times():
            following = self.following(piece, time)
            result += [self.jump(piece, following), self.kept(piece, following), following.J]
            piece = following
        return result

    def until(self, time: float) -> tuple[Array, Array, Array, Array]:
        """Up to the event at this time: J at fixed time just before it, F at the start, what the event makes of J.

        The last two: derivatives of the state after the event, and of its time, by the state just before it.
        """
        piece = self.begin()
        F_start = np.concatenate([piece.x[self.n :], point.field(self.s, piece.t, piece.x)[self.n :]])
        J = piece.J @ self.lost(piece)
        while piece.end < time - SAME * self.scale:
            following = self.following(piece, piece.end)
            J = following.J @ self.kept(piece, following) @ self.jump(piece, following) @ J
            piece = following
        after, events = self.following(piece, piece.end), self.happened(piece.end)
        if Kind.ACCUMULATION in set(events.kind) or self.at_corner(piece.end):
            raise LcpStepError(f"what happens at t = {time:g} s has no guard whose time the state decides")
        self.hold_to_the_end(piece)
        F = point.field(self.s, piece.end, piece.x_end)
        H_x, slope = self.guard(piece, events, F)
        R_x, R_t = self.law(piece, after, events)
        R = R_x - np.outer(R_x @ F + R_t, H_x) / slope
        return J, F_start, self.kept(piece, after) @ R, -H_x / slope

    def law(self, before: Piece, after: Piece, events: Any) -> tuple[Array, Array]:
        """R_x and R_t of the state after the events."""
        if Kind.IMPACT in set(events.kind):
            return Blow(self, before, after, events).derivatives()
        return np.eye(2 * self.n), np.zeros(2 * self.n)

    def at_corner(self, t: float) -> bool:
        """Whether this is the time of a corner of the scene."""
        return any(abs(t - c) <= SAME * self.scale for c in self.corners(t, t))

    def times(self) -> list[float]:
        """Times of events after the start, each once."""
        t, end = float(self.run.t[0]), float(self.run.t[-1])
        found: list[float] = []
        for time in self.log.time:
            last = found[-1] if found else t
            if last + SAME * self.scale < time <= end:
                found.append(float(time))
        return found

    def happened(self, time: float) -> Any:
        """Lines of the log at this time."""
        return self.log[np.abs(self.log.time - time) <= SAME * self.scale]

    def begin(self) -> Piece:
        """The first piece; at the edge of the cone, to rounding, the log says whether it slips at once."""
        t, x = float(self.run.t[0]), self.state(float(self.run.t[0]))
        mode, direction = self.found(t, x)
        slips = [e.contact for e in self.happened(t) if e.kind == Kind.SLIP and mode[e.contact] == STICKS]
        if slips and point.hold(self.s, t, x, mode, direction):
            pulled = point.forces(self.s, t, x)[self.s.n_j + self.s.n_c :]
            for c in slips:
                mode[c], direction[c] = SLIDES, -np.sign(pulled[c])
        return self.piece(t, x, mode, direction)

    def state(self, time: float) -> Array:
        """The state right after the events at this time."""
        row = max(int(np.searchsorted(self.run.t, time + SAME * self.scale, side="right")) - 1, 0)
        return np.concatenate([self.run.q[row], self.run.v[row]])

    def found(self, t: float, x: Array, before: Any = None) -> tuple[Any, Array]:
        """The modes with which the motion goes on from this state: closed are the contacts that the log says."""
        closed = np.zeros(self.s.n_c, dtype=bool) if before is None else before != OPEN
        for event in self.happened(t):
            if event.kind in (Kind.STICK, Kind.RELEASE):
                closed[event.contact] = event.kind == Kind.STICK
        code = point.settle(self.s, t, x, closed)
        if code != Status.DONE:
            raise LcpStepError(f"no modes follow the events at t = {t:g} s: {Status(code).name}")
        return point.modes(self.s)

    def piece(self, t: float, x: Array, mode: Any, direction: Array) -> Piece:
        """The smooth motion to the next event, with its derivative."""
        later = [time for time in self.times() if time > t + SAME * self.scale]
        end, aside = later[0] if later else float(self.run.t[-1]), x + ASIDE * self.sizes
        if not point.hold(self.s, t, x, mode, direction):
            raise LcpStepError(f"no forces hold the closed contacts at t = {t:g} s")
        smooth = self.sizes
        if not self.flow.steady:
            smooth = lengths(lambda y: point.field(self.s, t, y), aside, RELATIVE_STEP, self.sizes)
        self.flow.start(t, x, smooth)
        x_end, J = self.flow.reached()
        last, x_last = t, x
        for a, b in self.between_corners(t, end):
            last, x_last = a, x_end
            point.hold(self.s, a, x_end, mode, direction)
            code = self.flow.go_on(a, b)
            if code != Status.DONE:
                raise LcpStepError(f"the variational flow could not be integrated: {Status(code).name}")
            x_end, J = self.flow.reached()
        return Piece(t, x, last, x_last, end, x_end, mode, direction, J)

    def between_corners(self, t: float, end: float) -> list[tuple[float, float]]:
        """The span cut at the corners of the scene."""
        cuts = [t, *(c for c in self.corners(t, end) if t < c < end), end]
        return [(a, b) for a, b in pairwise(cuts) if b > a]

    def corners(self, t: float, end: float) -> list[float]:
        """Corners of the scene between two times."""
        own, T = np.asarray(self.scene.corners, dtype=float), self.scene.period
        if len(own) == 0 or not np.isfinite(T):
            return [float(c) for c in own]
        turns = np.arange(np.floor(t / T) - 1, np.ceil(end / T) + 1)
        return sorted(float(c) for c in np.ravel(own[None, :] + T * turns[:, None]))

    def following(self, piece: Piece, time: float) -> Piece:
        """The piece after the events at the end of this one."""
        x, events = self.state(time), self.happened(time)
        mode, direction = piece.mode.copy(), piece.direction.copy()
        if set(events.kind) & {Kind.IMPACT, Kind.ACCUMULATION, Kind.STICK}:
            return self.piece(time, x, *self.found(time, x, piece.mode))
        pulled = point.forces(self.s, time, piece.x_end)[self.s.n_j + self.s.n_c :]
        for event in events:
            c = event.contact
            if event.kind == Kind.RELEASE:
                mode[c] = OPEN
            elif event.kind == Kind.STICK_TANGENT:
                mode[c] = STICKS
            elif event.kind == Kind.REVERSE:
                direction[c] = -direction[c]
            elif event.kind == Kind.SLIP:
                mode[c], direction[c] = SLIDES, -np.sign(pulled[c])
        return self.piece(time, x, mode, direction)

    def jump(self, before: Piece, after: Piece) -> Array:
        """D of the events between two pieces."""
        t, events = after.t, self.happened(after.t)
        ended = sorted({int(e.contact) for e in events if e.kind == Kind.ACCUMULATION})
        if len(ended) > 1:
            when = f"contacts {ended} come to rest together at t = {t:g} s"
            raise LcpStepError(f"{when}; {refused('endless-together', self.run.scene)}")
        if ended:
            return self.lost(after)
        self.hold_to_the_end(before)
        F_before = point.field(self.s, t, before.x_end)
        R_x, R_t = self.law(before, after, events)
        if self.at_corner(t):
            return R_x  # the time is that of a corner, whatever the state
        H_x, slope = self.guard(before, events, F_before)
        self.hold_from_the_start(after)
        F_after = point.field(self.s, t, after.x)
        change = F_after - R_x @ F_before - R_t
        if np.max(np.abs(change)) <= CONTINUOUS * (np.max(np.abs(F_before)) + np.max(np.abs(F_after))):
            return R_x
        if not abs(slope) > 0.0:
            raise LcpStepError(
                f"the event at t = {t:g} s is not transversal: the motion has no derivative there"
            )
        return np.asarray(R_x + np.outer(change, H_x) / slope)

    def hold_from_the_start(self, piece: Piece) -> None:
        """Hold the modes of a piece, from where it begins."""
        point.hold(self.s, piece.t, piece.x, piece.mode, piece.direction)

    def hold_to_the_end(self, piece: Piece) -> None:
        """Hold the modes of a piece, with forces and obstacles as they are just before its end."""
        point.hold(self.s, piece.smooth, piece.x_smooth, piece.mode, piece.direction)

    def lost(self, piece: Piece) -> Array:
        """What is left of a deviation from the surfaces held from the start of a piece on, (2 n_q, 2 n_q)."""
        return lost(self.s, piece.t, piece.x, piece.mode, piece.direction, self.sizes)

    def kept(self, before: Piece, after: Piece) -> Array:
        """Puts what lies on surfaces that are new after the events onto them to the last digit."""
        if all(new <= old for new, old in zip(self.holds(after), self.holds(before), strict=True)):
            return np.eye(2 * self.n)
        return self.lost(after)

    def holds(self, piece: Piece) -> list[int]:
        """0 of an open contact, 1 of a closed one, 2 of one that sticks."""
        return [0 if m == OPEN else 2 if m == STICKS else 1 for m in piece.mode]

    def guard(self, before: Piece, events: Any, F: Array) -> tuple[Array, float]:
        """H_x and H_x F- + H_t of what has triggered the events, under the modes before them."""
        t, x = float(events.time[0]), before.x_end
        c, column = self.trigger(before, events)
        self.hold_to_the_end(before)
        if column == 0 and before.mode[c] == OPEN:
            R, _, rate, _ = point.rows(self.s, t, x)
            G, rate = R[self.s.n_j + c], rate[self.s.n_j + c]
            return np.append(G, np.zeros(self.n)), float(G @ x[self.n :] + rate)

        def value(time: float, y: Array) -> float:
            return float(point.guards(self.s, time, np.ascontiguousarray(y))[c, column])

        H_x = derivative(lambda y: value(t, y), x, STEP, self.sizes)[0]
        d_t = STEP * max(before.end - before.t, 1e-3 * self.scale)
        along = [value(t - k * d_t, x - k * d_t * F) for k in range(5)]  # from before the event
        slope = np.dot((25.0, -48.0, 36.0, -16.0, 3.0), along) / (12.0 * d_t)
        return H_x, float(slope)

    def trigger(self, before: Piece, events: Any) -> tuple[int, int]:
        """Contact and number of the guard (`events.contacts.guards`) that has acted first."""
        struck = sorted(
            {int(e.contact) for e in events if e.kind == Kind.IMPACT and before.mode[e.contact] == OPEN}
        )
        if len(struck) > 1:
            when = f"contacts {struck} strike together at t = {events.time[0]:g} s"
            raise LcpStepError(f"{when}; {refused('together', self.run.scene)}")
        if struck:
            return struck[0], 0
        for event in events:
            if event.kind in (Kind.STICK_TANGENT, Kind.REVERSE):
                return int(event.contact), 1
        for event in events:
            if event.kind == Kind.RELEASE:
                return int(event.contact), 0
            if event.kind == Kind.SLIP:
                edges = point.guards(self.s, float(event.time), before.x_end)[event.contact]
                return int(event.contact), 1 if abs(edges[1]) < abs(edges[2]) else 2
        raise LcpStepError(
            f"a contact closes without speed at t = {events.time[0]:g} s: the motion has no derivative"
        )
