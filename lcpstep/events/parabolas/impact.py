"""The impact of all contacts that are closed at one time, as kernels.

    0 <= u+ + r u-  complementary to  p >= 0,        u+ = u- + W p        (Newton's law in Moreau's form)

It takes all contacts that are closed, to rounding, and do not separate, but for those that elastic bodies of one mass
exchange their speeds at, which follow one another: so the energy falls by sum (1 - r) |u-| p / 2
whatever the restitution of each. A contact that has separated at the same instant and is pushed back strikes anew, in
a problem of its own. Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer
2008), chapter 3.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN, SLIDES
from lcpstep.events.parabolas.forces import joints_own, solve_members
from lcpstep.events.parabolas.state import Mechanism
from lcpstep.events.rows.chatter import CHECKED
from lcpstep.events.rows.exchange import leave_for_later, some_exchange
from lcpstep.events.rows.held import add_column, constrain, hold, hold_joints
from lcpstep.kernels.vectors import clear, copy, largest, product
from lcpstep.pointers import abs, min


def strike(s: Mechanism) -> bool:
    """The impact of the contacts whose gap is zero and that do not separate; p into `problem.impulse`, by member.

    Velocities and contact speeds are those after it. False where none exists. What is held from all sides cannot
    leave every obstacle as its restitution asks, and speeds carried along may not agree with the velocities: where no
    impulses answer, they but end the approach, and at last that which the velocities have.
    """
    gather(s)
    if solve_law(s, True) or solve_law(s, False):
        return True
    for c in range(s.n_c):
        s.velocity[s.n_j + c] = product(s.R, s.v, s.n_j + c, s.n_q)
        if s.mode[c] != OPEN:
            s.mode[c], s.gap[s.n_j + c] = OPEN, 0.0
    gather(s)
    found = solve_law(s, False)
    for a in range(0 if found else s.n_members):  # as a message names them
        s.mode[s.problem.ids[a]] = SLIDES
    return found


def gather(s: Mechanism) -> None:
    """The contacts that take part: those whose gap is zero and that do not separate; those of joints bear nothing."""
    s.n_members = 0
    hold_joints(s)
    for c in range(s.n_c):
        s.loaded[c] = 0
        u = s.velocity[s.n_j + c] if s.mode[c] == OPEN else 0.0
        touches = s.gap[s.n_j + c] == 0.0 and s.parting[c] == 0
        takes_part = s.mode[c] != OPEN or (touches and u <= s.noise(c))
        if takes_part and not (u >= -s.noise(c) and joints_own(s, c)):
            s.problem.ids[s.n_members], s.lift[s.n_members] = c, s.noise(c)
            s.n_members += 1
    touched = s.length == 0.0
    if some_exchange(s, s.n_members, touched):
        s.n_members = leave_for_later(s, s.n_members, touched)
        for a in range(s.n_members):
            s.lift[a] = s.noise(s.problem.ids[a])


def solve_law(s: Mechanism, rebounds: bool) -> bool:
    """Impulses by the law, with restitution or without it, applied; False where there are none."""
    for a in range(s.n_members):
        c = s.problem.ids[a]
        u = min(s.velocity[s.n_j + c], 0.0) if s.mode[c] == OPEN else 0.0
        s.problem.rate[a] = (1.0 + s.model.restitution[c]) * u if rebounds else u
    hold_joints(s)
    solved = solve_members(s)
    most = impulses(s)
    for a in range(s.n_members):
        if s.problem.impulse[a] < 0.0:
            if not solved and s.problem.impulse[a] < -CHECKED * most:
                return False
            s.problem.impulse[a] = s.change[s.n_kept + a] = 0.0
    if not solved and not separates(s):
        return False
    for m in range(s.n_held):
        s.push(s.row[m], s.change[m])
    return True


def impulses(s: Mechanism) -> float:
    """Impulses of the members, of which those found are a guess, and of joints into `change`; returns the largest.

    They give the loaded members the speeds of the law.
    """
    n_j, k, p, dv = s.n_j, s.n_members, s.problem.impulse, s.dv
    clear(dv, s.n_q)
    clear(s.near, s.n_r)
    hold_joints(s)
    for a in range(k):
        i = n_j + s.problem.ids[a]
        s.near[i] = s.problem.rate[a]
        add_column(s, s.MR, i, p[a], dv)
    for a in range(k):
        if s.loaded[s.problem.ids[a]] == 1:
            hold(s, n_j + s.problem.ids[a])
    clear(s.held, s.n_held)
    if k + s.n_kept > 1:  # one impulse alone loses no digits
        constrain(s, dv, s.near)
    clear(s.further, s.n_r)
    for m in range(s.n_held):
        s.further[s.row[m]] = s.held[m]
    copy(s.change, s.held, s.n_kept)
    s.n_held = s.n_kept + k
    for a in range(k):
        i = n_j + s.problem.ids[a]
        p[a] = p[a] + s.further[i]
        s.row[s.n_kept + a], s.change[s.n_kept + a] = i, p[a]
    return largest(p, 0.0, k)


def separates(s: Mechanism) -> bool:
    """Whether every member has at least the speed of the law after the impulses found."""
    for a in range(s.n_members):
        u, i = s.problem.rate[a], s.n_j + s.problem.ids[a]
        size = abs(u)
        for m in range(s.n_held):
            u += s.D[i * s.n_r + s.row[m]] * s.change[m]
            size += abs(s.D[i * s.n_r + s.row[m]] * s.change[m])
        if u < -CHECKED * size:
            return False
    return True
