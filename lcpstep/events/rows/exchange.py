"""Which of the contacts that are closed at one instant strike one after another, as kernels.

Elastic bodies of one mass that meet by threes exchange their speeds, whichever pair is first; struck together they
would part otherwise. Rounding tells whether their gaps close at one instant, and must not decide
(`kernels.together.order_matters`).
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN
from lcpstep.events.rows.contacts import Contacts
from lcpstep.kernels.together import order_matters
from lcpstep.pointers import inf

LATER, UNTOLD, HERE, NEXT = -1, 0, 1, 2  # whether a member strikes now


def some_exchange(s: Contacts, n: int, touched: bool) -> bool:
    """Whether there are two among the n members, `problem.ids`, that do; touched: whether no time has passed."""
    for a in range(1, n):
        for b in range(a):
            if exchange(s, s.problem.ids[a], s.problem.ids[b], touched):
                return True
    return False


def exchange(s: Contacts, c: int, d: int, touched: bool) -> bool:
    """Whether the impacts of two contacts follow each other, since their order makes no difference.

    Those that touch since the start are pushed together.
    """
    i, k = s.n_j + c, s.n_j + d
    if s.D[i * s.n_r + k] == 0.0 or not (strikes(s, c) and strikes(s, d)):
        return False
    if touched and s.struck[c] == -inf and s.struck[d] == -inf:
        return False
    r, W_c, W_d = s.model.restitution, s.D[i * s.n_r + i], s.D[k * s.n_r + k]
    return not order_matters(W_c, W_d, s.D[i * s.n_r + k], r[c], r[d], s.velocity[i], s.velocity[k])


def strikes(s: Contacts, c: int) -> bool:
    """Whether contact c is open and approaches."""
    return s.mode[c] == OPEN and s.velocity[s.n_j + c] < -s.noise(c)


def leave_for_later(s: Contacts, n: int, touched: bool) -> int:
    """Take away the members that but exchange speeds with some that strike faster: the next impact is theirs.

    With each goes what it is struck together with. How many are left of `problem.ids`.
    """
    ids, taken = s.problem.ids, s.tried
    for c in range(s.n_c):
        taken[c] = UNTOLD
    first = fastest(s, n)
    while first >= 0:
        taken[first] = NEXT
        when = LATER if link(s, n, touched) else HERE
        for a in range(n):
            if taken[ids[a]] == NEXT:
                taken[ids[a]] = when
        first = fastest(s, n)
    left = 0
    for a in range(n):
        if taken[ids[a]] != LATER:
            ids[left] = ids[a]
            left += 1
    return left


def fastest(s: Contacts, n: int) -> int:
    """The member that strikes fastest of those of which it is not told yet when, or -1."""
    found = -1
    for a in range(n):
        c = s.problem.ids[a]
        faster = found < 0 or s.velocity[s.n_j + c] < s.velocity[s.n_j + found]
        if s.tried[c] == UNTOLD and strikes(s, c) and faster:
            found = c
    return found


def link(s: Contacts, n: int, touched: bool) -> bool:
    """Take along (NEXT) what is struck together with members taken; whether they wait for some that strike HERE."""
    ids, taken, waits, more = s.problem.ids, s.tried, False, True
    while more:
        more = False
        for a in range(n):
            for b in range(n):
                c, d = ids[a], ids[b]
                linked = taken[c] == NEXT and s.D[(s.n_j + c) * s.n_r + s.n_j + d] != 0.0
                if linked and taken[d] == UNTOLD and not exchange(s, c, d, touched):
                    taken[d], more = NEXT, True
                waits = waits or (linked and taken[d] == HERE)
    return waits
