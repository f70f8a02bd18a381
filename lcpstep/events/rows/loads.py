"""Forces of rows that depend on each other, as kernels.

Of contacts they are shifted until those that carry one are independent:

    C_c = sum_m y_m C_m over the rows held,    lambda_m <- lambda_m + y_m x,    lambda_c <- lambda_c - x

changes no acceleration. Taken as far as x lets no force become negative, it takes the load from one contact
(Caratheodory); so the rows that will be held are of contacts that push, in whatever order they are held. Source:
R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem (SIAM 2009), chapter 2.
"""

from __future__ import annotations

from math import sqrt

import cython

from lcpstep.events.rows.equations import couple, other, respond_to
from lcpstep.events.rows.held import hold, hold_joints, is_held, solve_held
from lcpstep.events.rows.state import Rows
from lcpstep.kernels.vectors import add, clear, product
from lcpstep.pointers import Doubles, Indices, after


def unload(s: Rows, force: Doubles, loaded: Indices) -> None:
    """Shift the forces of contacts until those `loaded` are independent; shares of their rows must be known."""
    while shift(s, force, loaded):  # each round takes the load from one contact
        pass


def shift(s: Rows, force: Doubles, loaded: Indices) -> bool:
    """Take the load from one of the contacts that depend on each other; False where there are none."""
    hold_joints(s)
    for c in range(s.n_c):
        k = s.n_held
        if loaded[c] == 1 and hold(s, s.n_j + c) and s.n_held == k:
            leaves = spread(s, c, force)
            force[leaves], loaded[leaves] = 0.0, 0
            return True
    return False


def spread(s: Rows, c: int, force: Doubles) -> int:
    """Spread the force of contact c over the rows held, on which it depends; the first contact left without one."""
    i, k, y = s.n_j + c, s.n_held, s.change
    for m in range(k):
        y[m] = s.D[s.row[m] * s.n_r + i]
        if s.share[i] != 0.0:
            y[m] += s.share[i] * s.D[s.row[m] * s.n_r + other(s, i)]
    solve_held(s, y)
    share, leaves = force[c], c
    for m in range(s.n_kept, k):
        d = s.row[m] - s.n_j
        if force[d] + share * y[m] < 0.0:
            share, leaves = force[d] / -y[m], d
    for m in range(s.n_kept, k):
        force[s.row[m] - s.n_j] += share * y[m]
    force[c] -= share
    return leaves


def list_by_row(s: Rows, x: Doubles, out: Doubles) -> None:
    """Forces or impulses by row, of x of the rows held: with their shares, and on all joints that say the same."""
    clear(out, s.n_r)
    for m in range(s.n_held):
        i = s.row[m]
        out[i] += x[m]
        if s.share[i] != 0.0:
            out[other(s, i)] += s.share[i] * x[m]
    share_out(s, out)


def share_out(s: Rows, x: Doubles) -> None:
    """Forces or impulses x of joints, by row, where some say the same: of least norm, which change no motion.

    Each is measured in the unit in which its joint has unit mobility. What such joints can take from each other is
    taken out of x, one left out after the other.
    """
    n, count = s.n_j, 0
    for i in range(n if s.n_kept < n else 0):
        z = after(s.idle, count * n)
        if not is_held(s, i) and find_idle(s, i, z):
            for m in range(count):
                add(z, -product(s.idle, z, m, n), after(s.idle, m * n), n)
            size = sqrt(product(z, z, 0, n))
            for k in range(n):
                z[k] /= size
            count += 1
    for m in range(count):
        z, part = after(s.idle, m * n), 0.0
        for k in range(n):
            part += z[k] * x[k] * sqrt(s.D[k * s.n_r + k])
        for k in range(n):
            if z[k] != 0.0:
                x[k] -= part * z[k] / sqrt(s.D[k * s.n_r + k])


def find_idle(s: Rows, i: int, z: Doubles) -> bool:
    """Forces of joint i, which is left out, and of those held that together do nothing; False: it never does."""
    r, held, y = s.n_r, s.n_held, s.further
    respond_to(s, i)
    couple(s, i, i)
    for m in range(s.n_kept):
        couple(s, i, s.row[m])
        y[m] = s.D[i * r + s.row[m]]
    s.n_held = s.n_kept
    solve_held(s, y)
    s.n_held = held
    clear(z, s.n_j)
    z[i] = sqrt(s.D[i * r + i])
    for m in range(s.n_kept):
        z[s.row[m]] = -y[m] * sqrt(s.D[s.row[m] * r + s.row[m]])
    return z[i] > 0.0
