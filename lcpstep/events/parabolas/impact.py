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
from lcpstep.events.rows.held import add_column, constrain, hold, hold_joints
from lcpstep.kernels.together import order_matters
from lcpstep.kernels.vectors import clear, copy, largest, product
from lcpstep.pointers import abs, inf, min

LATER, UNTOLD, HERE, NEXT = -1, 0, 1, 2  # whether a member strikes now


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
    if some_exchange(s):
        leave_for_later(s)


def some_exchange(s: Mechanism) -> bool:
    """Whether there are two among the members that do."""
    for a in range(1, s.n_members):
        for b in range(a):
            if exchange(s, s.problem.ids[a], s.problem.ids[b]):
                return True
    return False


def exchange(s: Mechanism, c: int, d: int) -> bool:
    """Whether the impacts of two contacts follow each other, since their order makes no difference.

    As where rounding leaves their gaps a little open (`modes.has_come`): whether it does must not decide. Those that
    touch since the start are pushed together.
    """
    i, k = s.n_j + c, s.n_j + d
    if s.D[i * s.n_r + k] == 0.0 or not (strikes(s, c) and strikes(s, d)):
        return False
    if s.length == 0.0 and s.struck[c] == -inf and s.struck[d] == -inf:
        return False
    r, W_c, W_d = s.model.restitution, s.D[i * s.n_r + i], s.D[k * s.n_r + k]
    return not order_matters(W_c, W_d, s.D[i * s.n_r + k], r[c], r[d], s.velocity[i], s.velocity[k])


def strikes(s: Mechanism, c: int) -> bool:
    """Whether contact c is open and approaches."""
    return s.mode[c] == OPEN and s.velocity[s.n_j + c] < -s.noise(c)


def leave_for_later(s: Mechanism) -> None:
    """Take away the members that but exchange speeds with some that strike faster: the next impact is theirs.

    With each goes what it is struck together with.
    """
    ids, taken = s.problem.ids, s.tried
    for c in range(s.n_c):
        taken[c] = UNTOLD
    while True:
        fastest = -1
        for a in range(s.n_members):
            c = ids[a]
            faster = fastest < 0 or s.velocity[s.n_j + c] < s.velocity[s.n_j + fastest]
            if taken[c] == UNTOLD and strikes(s, c) and faster:
                fastest = c
        if fastest < 0:
            break
        taken[fastest] = NEXT
        waits = False
        more = True
        while more:
            more = False
            for a in range(s.n_members):
                for b in range(s.n_members):
                    c, d = ids[a], ids[b]
                    linked = taken[c] == NEXT and s.D[(s.n_j + c) * s.n_r + s.n_j + d] != 0.0
                    if linked and taken[d] == UNTOLD and not exchange(s, c, d):
                        taken[d], more = NEXT, True
                    waits = waits or (linked and taken[d] == HERE)
        for a in range(s.n_members):
            if taken[ids[a]] == NEXT:
                taken[ids[a]] = LATER if waits else HERE
    n = 0
    for a in range(s.n_members):
        if taken[ids[a]] != LATER:
            ids[n], s.lift[n] = ids[a], s.lift[a]
            n += 1
    s.n_members = n


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
