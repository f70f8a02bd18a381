"""Contacts that bear nothing by turns, beside joints: they are left out of a step that is not decided otherwise.

Two at one place, as ends of rods that a joint links, hand their load over to each other without end. One of them
bears it all then; the other may close no more than places in a step differ by.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.vectors import product, size_of_product
from lcpstep.pointers import abs
from lcpstep.stepping.theta_method.moving import Rows, State
from lcpstep.stepping.theta_method.row_impulses import take_part

MAY_CLOSE = 1e-2  # of a gap velocity's terms: by so much what is left out may close


def leave_out_idle(s: State, c: Rows, idle: int) -> int:
    """Leave out, after `idle` others, the active contacts that bear nothing in the last iteration; how many then."""
    ids, kept, n_a = c.problem.ids, 0, s.active
    for k in range(n_a):
        i = ids[k]
        ids[k], ids[kept] = ids[kept], i
        kept += 1 if c.p[i] > 0.0 else 0
    if kept == 0 or kept == n_a:
        return idle
    for k in range(kept, n_a):
        c.left_out[idle + k - kept] = ids[k]
    s.active = kept
    take_part(c, kept)
    return idle + n_a - kept


def take_back_idle(s: State, c: Rows, idle: int) -> bool:
    """Whether contacts left out do not close by more than places in a step differ; they are active all the same."""
    for k in range(idle):
        i = c.left_out[k]
        u = product(c.H, s.next_v, i, s.n_q) + c.H_t[i]
        terms = size_of_product(c.H, s.next_v, i, s.n_q) + size_of_product(c.H, s.v_free, i, s.n_q)
        if u < -MAY_CLOSE * (terms + abs(c.H_t[i])):
            return False
        c.problem.ids[s.active + k] = i
    s.active += idle
    return True
