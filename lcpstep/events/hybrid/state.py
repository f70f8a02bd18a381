"""A motion of a system with modes: its mode and state, what is known of the guards, and what has been kept."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.events.hybrid.field import Machine, field, guard
from lcpstep.events.hybrid.kinds import LEAD, LENGTH, ROW_MODE, SWITCH_LEAD, TIME
from lcpstep.events.hybrid.roots import SAMPLES, Scan
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.rungekutta import RungeKutta
from lcpstep.kernels.vectors import copy, finite
from lcpstep.pointers import Doubles, abs, after, inf

FIRST_STEP = 0.1  # of the longest


class Motion(RungeKutta):
    """A motion under way; its field is that of the mode at hand.

    t_end, longest, max_events   span and bounds: of the longest step, of switches
    now, mode, begun             where it is, and whether guards have been looked at
    due                          the guard by which a switch is due, or -1
    steps, events, stalled       taken; switches, those at one instant
    last_switch, brief           time of it; how long a mode lasted at most that a guard left within its band, of late
    acting, place                the guard found to act within a step, or -1; where, as a fraction of it
    slope, curvature             of that guard there, per step
    event_at, was_armed          its value there; whether it was below its band before
    secant, missed, tried        slope of it as told; its value, less `event_at`, after the step last tried; its size
    armed, band : (guards,)      whether each has been below its band since the mode began; how well it is known
    states : (samples, n)        of a step
    row, switches                rows and lines of the log written
    rows : (row_capacity, LEAD + n);  dense_rows : (row_capacity, 7, n);  log : (log_capacity, SWITCH_LEAD + 2 n)

    Parameters
    ----------
    machine : Machine
    t_end, longest, max_events   as above
    rtol, atol : tolerances
    rows, switches : int   room; rows = 0 where nothing but switches is kept
    positions : int   see `RungeKutta`
    """

    def __init__(
        self, machine: Machine, t_end: float, rtol: float, atol: float, longest: float, max_events: int,
        rows: int, switches: int, positions: int = 0,
    ) -> None:  # fmt: skip
        n = machine.n
        super().__init__(n, positions, rtol, atol)
        self.m, self.scan = machine, Scan()
        self.t_end, self.longest, self.max_events = t_end, longest, max_events
        self.kept_rows, self.kept_dense = np.zeros((rows, LEAD + n)), np.zeros((rows, 7, n))
        self.kept_log = np.zeros((switches, SWITCH_LEAD + 2 * n))
        self.lists, self.of_guards = np.zeros(machine.n_guards, dtype=np.intp), np.zeros(machine.n_guards)
        self.samples = np.zeros((SAMPLES, n))
        self.row_capacity, self.log_capacity = rows, switches
        self.rows, self.dense_rows = doubles(self.kept_rows), doubles(self.kept_dense)
        self.log, self.armed = doubles(self.kept_log), indices(self.lists)
        self.band, self.states = doubles(self.of_guards), doubles(self.samples)
        self.start_from(0.0, 0)

    def start_from(self, t: float, mode: int) -> None:
        """Begin at time t in a mode with the state y."""
        self.begin(FIRST_STEP * self.longest)
        self.now, self.last_switch, self.mode, self.begun, self.due = t, -inf, mode, False, -1
        self.acting, self.place, self.slope, self.curvature = -1, 2.0, 0.0, 0.0
        self.event_at, self.was_armed, self.brief = 0.0, False, 0.0
        self.secant = self.missed = self.tried = 0.0
        self.steps, self.events, self.stalled, self.row, self.switches = 0, 0, 0, 0, 0

    def start(self, t: float, x: Any, mode: int) -> None:
        """Begin at time t with the state x (n,) in a mode."""
        self.state[:] = x
        self.start_from(t, mode)

    def take(self) -> tuple[Any, Any, Any]:
        """Rows, dense output and switches kept since the last time; there is room again."""
        taken = (
            self.kept_rows[: self.row].copy(),
            self.kept_dense[: self.row].copy(),
            self.kept_log[: self.switches].copy(),
        )
        self.row, self.switches = 0, 0
        return taken

    @cython.ccall
    def make_room(self) -> None:
        """Twice as many lines of the log."""
        self.kept_log = np.concatenate([self.kept_log, np.zeros_like(self.kept_log)])
        self.log, self.log_capacity = doubles(self.kept_log), len(self.kept_log)

    def rates(self, t: float, y: Doubles, dy: Doubles) -> bool:
        """The field of the mode."""
        field(self.m, self.mode, t, y, dy)
        return finite(dy, self.n)

    def miss(self, t: float, tau: float) -> float:
        """By a secant of the guard that acts, with the slope that the last change has met where it did."""
        g, before = guard(self.m, self.mode, self.due, t + tau, self.y_new) - self.event_at, self.missed
        if g * before < 0.0 or abs(g) < 0.5 * abs(before):
            self.secant = (g - before) / (tau - self.tried)
        self.missed, self.tried = g, tau
        longer = -g / self.secant if self.secant > 0.0 else 0.0
        return longer if abs(longer) > RESOLUTION * tau else 0.0

    def keep(self, h: float) -> None:
        """One row: the state, the step that follows and its dense output."""
        n = self.n
        if self.row_capacity == 0 or h == 0.0:
            return
        row = after(self.rows, self.row * (LEAD + n))
        row[TIME], row[LENGTH], row[ROW_MODE] = self.now, h, self.mode
        copy(after(row, LEAD), self.y, n)
        if h > 0.0:
            copy(after(self.dense_rows, self.row * 7 * n), self.F, 7 * n)
        self.row += 1

    def note(self, target: int, guard: int, moved: Doubles) -> None:
        """One line of the log: guard acts at y, and leads to another mode and state."""
        n = self.n
        line = after(self.log, self.switches * (SWITCH_LEAD + 2 * n))
        line[0], line[1], line[2], line[3] = self.now, self.mode, target, guard
        copy(after(line, SWITCH_LEAD), self.y, n)
        copy(after(line, SWITCH_LEAD + n), moved, n)
        self.switches += 1
        self.events += 1
