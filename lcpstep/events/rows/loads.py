"""Forces of contacts that depend on each other, as kernels: shifted until those that carry one are independent.

    C_c = sum_m y_m C_m over the rows held,    lambda_m <- lambda_m + y_m x,    lambda_c <- lambda_c - x

changes no acceleration. Taken as far as x lets no force become negative, it takes the load from one contact
(Caratheodory); so the rows that will be held are of contacts that push, in whatever order they are held. Source:
R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem (SIAM 2009), chapter 2.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.rows.equations import other
    from lcpstep.events.rows.held import hold, hold_joints, solve_held
    from lcpstep.events.rows.state import Rows
    from lcpstep.pointers import Doubles, Indices


def unload(s: Rows, force: Doubles, loaded: Indices, n_c: int) -> None:
    """Shift the forces of n_c contacts until those `loaded` are independent; shares of their rows must be known."""
    while shift(s, force, loaded, n_c):  # each round takes the load from one contact
        pass


def shift(s: Rows, force: Doubles, loaded: Indices, n_c: int) -> bool:
    """Take the load from one of the contacts that depend on each other; False where there are none."""
    hold_joints(s)
    for c in range(n_c):
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
