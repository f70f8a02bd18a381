"""Contacts that a blow reaches, as kernels: by masses, joints and other contacts.

Springs and dampers carry no impulses, though the mobilities of an implicit step, in which they are, connect nearly
everything: it is asked of the rows that take part whether R_i M^-1 R_k^T is zero. Sparse steps ask for coordinates
that rows share (`sparse.stiction.connected`).
"""

from __future__ import annotations

from math import sqrt

import cython

from lcpstep.kernels.acceleration import factor_mass, response
from lcpstep.kernels.model import Model
from lcpstep.kernels.repose import contact_of
from lcpstep.kernels.vectors import product
from lcpstep.pointers import Doubles, abs, after
from lcpstep.stepping.theta_method.moving import Rows, State

JOINT = -1  # no contact
APART = 1e-12  # of the mobilities of two rows: what one does to the other, where rounding is all that it does


def reach(m: Model, s: State, c: Rows, n_a: int, n_f: int, t: float) -> bool:
    """Mark in `problem.sum`, where contacts that strike have 1, all that their impulses reach; False: no masses.

    t : time at the end of the step
    """
    n, n_k, ids, Y, own = s.n_q, n_a + n_f + c.n_j, c.problem.ids, c.answers, c.mobilities
    if not factor_mass(m, t, s.q, s.v, c.masses):
        return False
    for k in range(n_k):
        row = after(c.H, ids[k] * n)
        response(m, c.masses, s.try_q, row, after(Y, k * n))
        own[k], c.reached[k] = product(row, after(Y, k * n), 0, n), 0
    more = True
    while more:
        more = False
        for k in range(n_k):
            a = contact_of(c.problem, k, n_a) if k < n_a + n_f else JOINT
            if c.reached[k] == 0 and (is_met(c, own, k, n_k, n) or (a >= 0 and c.problem.sum[a] == 1.0)):
                c.reached[k], more = 1, True
                if a >= 0:
                    c.problem.sum[a] = 1.0
    return True


def is_met(c: Rows, own: Doubles, k: int, n_k: int, n: int) -> bool:
    """Whether an impulse of a row that has been reached moves row k."""
    row, some = after(c.H, c.problem.ids[k] * n), False
    for i in range(n_k):
        if not some and c.reached[i] == 1:
            some = abs(product(row, after(c.answers, i * n), 0, n)) > APART * sqrt(own[k] * own[i])
    return some
