"""Impulses of several contacts that depend on each other, put on independent ones.

Where W y = 0, as on a table with four feet, impulses z and z + s y do the same, and z is not unique. Some of those
that are positive can be taken to zero, until the contacts that bear the rest are independent: a load within a cone is
borne by independent rays of it. Source: C. Caratheodory, Rend. Circ. Mat. Palermo 32 (1911) 193.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.linear import grow_factor, solve_factored
from lcpstep.pointers import Doubles, max
from lcpstep.stepping.pieces.state import Work


def bear_on_independent(w: Work, W: Doubles, n: int) -> None:
    """Shift impulses until the contacts that bear any are independent."""
    k, n_k = first_dependent(w, W, n)
    while k >= 0:
        shift(w, W, n, k, n_k)
        k, n_k = first_dependent(w, W, n)


def first_dependent(w: Work, W: Doubles, n: int) -> tuple[int, int]:
    """The first contact with z > 0 that depends on such before it, or -1; how many these are, in the factor."""
    n_k = 0
    for k in range(n):
        if w.z[k] > 0.0:
            w.held[n_k], w.place[n_k] = w.chosen[k], k
            if not grow_factor(W, w.n_c, w.problem, n, w.held, w.doubt, n_k):
                return k, n_k
            n_k += 1
    return -1, n_k


def shift(w: Work, W: Doubles, n: int, k: int, n_k: int) -> None:
    """Shift z[k] to the first n_k that are held, on which its contact depends, until it or one of these is zero."""
    emptied, most = k, w.z[k]
    for i in range(n_k):
        w.change[i] = W[w.held[i] * w.n_c + w.chosen[k]]
    solve_factored(w.problem, n, n_k, w.change)
    for i in range(n_k):
        j = w.place[i]
        if w.z[j] < -w.change[i] * most:
            emptied, most = j, -w.z[j] / w.change[i]
    for i in range(n_k):
        j = w.place[i]
        w.z[j] = max(0.0, w.z[j] + w.change[i] * most)
    w.z[k] -= most
    w.z[emptied] = 0.0
