"""Derivative of a motion with modes by its initial state, along its log of switches, as kernels.

    J' = F_x J in a mode,    D = R_x + (F+ - R_x F- - R_t) H_x / (H_x F- + H_t) at a switch

with the reset R and the guard H. Switches at one instant are one: the guard is that of the first, the reset all of
theirs one after another, F+ the field of the last mode; the modes between have no duration, and their fields no say.
A switch at the very start puts the mode right, at a time that does not move: D = R_x. Sliding that begins loses a
dimension by the same formula, for there F+ is Filippov's field and H_x D = 0; so one multiplier of an orbit that
slides is zero. A motion that starts sliding is one that has been put on the surface first. Source: G. Osorio, Complex
Behavior in Impacting Systems, eqs. 3.42-3.43; R. Leine, H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth
Mechanical Systems (Springer 2004), chapter 7.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.events.hybrid.field import (
    INNER,
    LOST,
    OUTER,
    SHORTENINGS,
    SHORTER,
    SMOOTH,
    Machine,
    field,
    guard_gradient,
    reach,
    surface_gradient,
)
from lcpstep.events.hybrid.kinds import ARRIVE, NOT_SLIDING, SWITCH_LEAD
from lcpstep.kernels.flow import derivative_rates, follow
from lcpstep.kernels.rungekutta import RungeKutta
from lcpstep.kernels.status import DONE, NOT_TRANSVERSAL
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import Doubles, abs, after, inf, max, whole

TOLERANCE = 1e-12  # of the variational flow
RELATIVE_STEP: float = np.finfo(float).eps ** 0.2 * 0.1  # of the differences of fields and resets
VECTORS = 8


class Tangent(RungeKutta):
    """A state and its derivative by the initial one, which move together: n_x + n_x^2 numbers.

    n_x, m       of the system, a Machine;  mode   at hand
    J : (n_x, n_x)      the derivative so far
    F_x : (n_x, n_x)    derivative of the field
    S : (n_x, n_x)      D of a switch, or the derivative of one reset
    R, R_t : (n_x, n_x), (n_x,)   derivatives of all resets at one instant
    H_x, x, start : (n_x,)   gradient of a guard; a shifted state; state at the start of a piece
    F_before, F_after, up, down : (n_x,)   fields and values on both sides
    derivative : (n_x, n_x) array   J as Python sees it
    """

    def __init__(self, machine: Machine) -> None:
        n = machine.n
        super().__init__(n + n * n, 0, TOLERANCE, TOLERANCE * machine.shortest, False)
        self.n_x, self.m, self.mode = n, machine, 0
        self.derivative, self.squares, self.vectors = (
            np.zeros((n, n)),
            np.zeros((3, n, n)),
            np.zeros((VECTORS, n)),
        )
        self.J, self.F_x, self.R_t = doubles(self.derivative), doubles(self.squares), doubles(self.vectors)
        self.S, self.R = after(self.F_x, n * n), after(self.F_x, 2 * n * n)
        self.H_x, self.x, self.start = after(self.R_t, n), after(self.R_t, 2 * n), after(self.R_t, 3 * n)
        self.F_before, self.F_after = after(self.R_t, 4 * n), after(self.R_t, 5 * n)
        self.up, self.down = after(self.R_t, 6 * n), after(self.R_t, 7 * n)

    def along(self, log: Any, mode: int, t: float, x: Any, t_end: float) -> int:
        """Derivative of the state at t_end by the state x (n_x,) at t; a status.

        log : (m, SWITCH_LEAD + 2 n_x)   the switches between
        mode : at t, before any switch there
        """
        log, x = np.ascontiguousarray(log, dtype=float), np.array(x, dtype=float)
        lines, count, begin = doubles(log), len(log), doubles(x)
        return walk(self, lines, count, mode, t, begin, t_end)

    def rates(self, t: float, y: Doubles, dy: Doubles) -> bool:
        """Rates of the state and of its derivative: F and F_x J."""
        variation(self, t, y, dy)
        return True


def walk(s: Tangent, log: Doubles, count: int, mode: int, t: float, x: Doubles, t_end: float) -> int:
    """Derivative of the state at t_end by the state x at t, into s.J, along `count` lines of a log; a status."""
    n, k = s.n_x, 0
    line = SWITCH_LEAD + 2 * n
    copy(s.start, x, n)
    unit(s.J, n)
    now, t_first = t, t
    s.mode = mode
    if s.m.below[mode] != NOT_SLIDING:
        put_on_surface(s, t)
        times(s, s.R)
    while k < count:
        time = log[k * line]
        code = flow(s, now, time)
        if code != DONE:
            return code
        first = k
        now = time
        while k + 1 < count and log[(k + 1) * line] == now:
            k += 1
        if not switch(s, after(log, first * line), k - first, now > t_first):
            return NOT_TRANSVERSAL
        s.mode = whole(log[k * line + 2])
        copy(s.start, after(log, k * line + SWITCH_LEAD + n), n)
        k += 1
    return flow(s, now, t_end)


def unit(J: Doubles, n: int) -> None:
    """J <- 1."""
    for i in range(n):
        for j in range(n):
            J[i * n + j] = 1.0 if i == j else 0.0


def times(s: Tangent, D: Doubles) -> None:
    """J <- D J."""
    n = s.n_x
    for j in range(n):
        for i in range(n):
            s.up[i] = 0.0
            for k in range(n):
                s.up[i] += D[i * n + k] * s.J[k * n + j]
        for i in range(n):
            s.J[i * n + j] = s.up[i]


def flow(s: Tangent, a: float, b: float) -> int:
    """Smooth motion in the mode from s.start at a to b, state and derivative together; a status."""
    n = s.n_x
    copy(s.y, s.start, n)
    copy(after(s.y, n), s.J, n * n)
    code = follow(s, a, b)
    copy(s.J, after(s.y, n), n * n)
    return code


def variation(s: Tangent, t: float, z: Doubles, out: Doubles) -> None:
    """Rates of the state and of its derivative: F and F_x J."""
    n = s.n_x
    for j in range(n):
        column(s, t, z, j)
    copy(s.x, z, n)
    field(s.m, s.mode, t, s.x, s.up)
    copy(out, s.up, n)
    derivative_rates(s.F_x, after(z, n), after(out, n), n)


def column(s: Tangent, t: float, z: Doubles, j: int) -> None:
    """Derivative of the field by state j, into F_x, over a length within which it is smooth, as of `field.slope`."""
    longest = RELATIVE_STEP * reach(s.m, j, z[j])
    d, best, least = longest, longest, inf
    for _ in range(SHORTENINGS):
        unlike = quotients(s, t, z, j, d)
        if not unlike > SMOOTH:
            return
        if unlike < least:
            best, least = d, unlike
        elif least <= LOST:
            break
        d *= SHORTER
    quotients(s, t, z, j, best if least <= LOST else longest)


def quotients(s: Tangent, t: float, z: Doubles, j: int, d: float) -> float:
    """The same by differences over d and 2 d; by what share these differ."""
    n, size, unlike = s.n_x, 0.0, 0.0
    for k in range(2):
        step, weight = (d, 2.0 * INNER) if k == 0 else (2.0 * d, 4.0 * OUTER)
        copy(s.x, z, n)
        later, earlier = z[j] + step, z[j] - step
        s.x[j] = later
        field(s.m, s.mode, t, s.x, s.up)
        s.x[j] = earlier
        field(s.m, s.mode, t, s.x, s.down)
        for i in range(n):
            share = weight * (s.up[i] - s.down[i]) / (later - earlier)
            near = s.F_x[i * n + j] / (2.0 * INNER)
            size = max(size, abs(share / weight))
            unlike = max(unlike, abs(share / weight - near)) if k > 0 else 0.0
            s.F_x[i * n + j] = share if k == 0 else s.F_x[i * n + j] + share
    return unlike / size if size > 0.0 else 0.0


def switch(s: Tangent, lines: Doubles, further: int, moves: bool) -> bool:
    """J <- D J for a switch and those `further` at its instant; moves: whether this depends on the state.

    lines : of the log, from the first of them on
    """
    n, t, line = s.n_x, lines[0], SWITCH_LEAD + 2 * s.n_x
    before, last = after(lines, SWITCH_LEAD), after(lines, further * line)
    unit(s.R, n)
    for i in range(n):
        s.R_t[i] = 0.0
    for k in range(further + 1):
        compose(s, after(lines, k * line), t)
    if not moves:
        times(s, s.R)
        return True
    source = whole(lines[1])
    H_t = guard_gradient(s.m, source, whole(lines[3]), t, before)
    copy(s.H_x, s.m.g_x, n)
    field(s.m, source, t, before, s.F_before)
    field(s.m, whole(last[2]), t, after(last, SWITCH_LEAD + n), s.F_after)
    crossing = H_t
    for i in range(n):
        crossing += s.H_x[i] * s.F_before[i]
    if not abs(crossing) > 0.0:
        return False
    for i in range(n):
        gain = s.F_after[i] - s.R_t[i]
        for j in range(n):
            gain -= s.R[i * n + j] * s.F_before[j]
        for j in range(n):
            s.S[i * n + j] = s.R[i * n + j] + gain * s.H_x[j] / crossing
    times(s, s.S)
    return True


def compose(s: Tangent, line: Doubles, t: float) -> None:
    """R and R_t with the reset of a switch after them, and the surface of a sliding mode that it leads to."""
    n, guard, target = s.n_x, whole(line[3]), whole(line[2])
    if s.m.has_reset[guard] != 0:
        before = after(line, SWITCH_LEAD)
        for j in range(n):
            differenced(s, guard, t, before, j, RELATIVE_STEP * reach(s.m, j, before[j]))
            for i in range(n):
                s.S[i * n + j] = s.up[i]
        product(s)
        differenced(s, guard, t, before, -1, s.m.dt)
        for i in range(n):
            s.R_t[i] += s.up[i]
    if s.m.below[target] != NOT_SLIDING and s.m.kind[guard] != ARRIVE:
        H_t, square = surface_gradient(s.m, target, t, after(line, SWITCH_LEAD + n)), 0.0
        for i in range(n):
            square += s.m.H_x[i] * s.m.H_x[i]
        for i in range(n):
            for j in range(n):
                s.S[i * n + j] = (1.0 if i == j else 0.0) - s.m.H_x[i] * s.m.H_x[j] / square
        product(s)
        for i in range(n):
            s.R_t[i] -= s.m.H_x[i] * H_t / square


def product(s: Tangent) -> None:
    """R <- D R, R_t <- D R_t."""
    n = s.n_x
    for j in range(n + 1):
        for i in range(n):
            s.down[i] = 0.0
            for k in range(n):
                s.down[i] += s.S[i * n + k] * (s.R[k * n + j] if j < n else s.R_t[k])
        for i in range(n):
            if j < n:
                s.R[i * n + j] = s.down[i]
            else:
                s.R_t[i] = s.down[i]


def differenced(s: Tangent, guard: int, t: float, x: Doubles, j: int, d: float) -> None:
    """Derivative of a reset by state j, or by the time where j is -1, into s.up."""
    n = s.n_x
    for i in range(n):
        s.F_after[i] = 0.0
    for k in range(4):
        step, weight = (d, INNER) if k < 2 else (2.0 * d, OUTER)
        side = 1.0 if k % 2 == 0 else -1.0
        copy(s.x, x, n)
        if j >= 0:
            s.x[j] = x[j] + side * step
        s.m.resets.fill(guard, t + (side * step if j < 0 else 0.0), s.x, s.x, s.up)
        for i in range(n):
            s.F_after[i] += side * weight * s.up[i] / d
    copy(s.up, s.F_after, n)


def put_on_surface(s: Tangent, t: float) -> None:
    """R of putting a state on the surface of its sliding mode: the nearest one there."""
    n, square = s.n_x, 0.0
    surface_gradient(s.m, s.mode, t, s.start)
    for i in range(n):
        square += s.m.H_x[i] * s.m.H_x[i]
    for i in range(n):
        for j in range(n):
            s.R[i * n + j] = (1.0 if i == j else 0.0) - s.m.H_x[i] * s.m.H_x[j] / square
