"""Contacts that a blow reaches, as kernels: by masses, joints and other contacts.

Springs and dampers carry no impulses, though the mobilities of an implicit step, in which they are, connect nearly
everything. `sparse_stiction.connected` has the same rule.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.model import Model
from lcpstep.pointers import Doubles, after
from lcpstep.stepping.theta_method.moving import Rows, State


def reach(m: Model, s: State, c: Rows, n_a: int, n_f: int) -> None:
    """Mark in `problem.sum`, where contacts that strike have 1, all that their impulses reach."""
    M, n, ids, more = m.M if m.linear else s.M, s.n_q, c.problem.ids, True
    for j in range(n):
        c.hit[j] = 0
    while more:
        more = False
        for k in range(n_a + n_f + c.n_j):
            row = after(c.H, ids[k] * n)
            if k >= n_a + n_f:
                more = (is_hit(c, row, n) and hit(c, row, n)) or more
                continue
            a = k if k < n_a else c.problem.carrier[k - n_a]
            if c.problem.sum[a] == 1.0 or is_hit(c, row, n):
                c.problem.sum[a] = 1.0
                more = hit(c, row, n) or more
        for j in range(n):
            if c.hit[j] == 1:
                more = hit(c, after(M, j * n), n) or more


def is_hit(c: Rows, row: Doubles, n: int) -> bool:
    """Whether one of the coordinates that a row is of moves."""
    some = False
    for j in range(n):
        some = some or (row[j] != 0.0 and c.hit[j] == 1)
    return some


def hit(c: Rows, row: Doubles, n: int) -> bool:
    """All of them move; whether one did not before."""
    some = False
    for j in range(n):
        if row[j] != 0.0 and c.hit[j] == 0:
            c.hit[j], some = 1, True
    return some
