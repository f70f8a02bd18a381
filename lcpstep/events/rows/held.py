"""Which rows are held, as kernels, and whether joints left out, for they depend on these, agree with them."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.rows.equations import size_of, size_of_acceleration
    from lcpstep.events.rows.state import Rows
    from lcpstep.kernels.vectors import product
    from lcpstep.pointers import Doubles, abs, max

PARTED = 1e3  # tolerances by which joints that say the same may differ
DISAGREEMENT = 1e-8  # relative acceleration that joints may not agree about


def is_held(s: Rows, i: int) -> bool:
    """Whether row i is among the rows held."""
    found = False
    for m in range(s.n_held):
        found = found or s.row[m] == i
    return found


def contradiction(s: Rows, a: Doubles) -> int:
    """The first joint left out whose acceleration is not zero under that of the others, or -1."""
    for i in range(s.n_j):
        off = abs(product(s.R, a, i, s.n_q) + s.bias[i])
        if not is_held(s, i) and off > DISAGREEMENT * size_of_acceleration(s, i, a):
            return i
    return -1


def parted(s: Rows, gap: Doubles, q: Doubles) -> int:
    """The first joint left out that the others have not kept closed, or -1; gaps and rows must be those of q.

    It is as far open as these, of which long steps leave more than the tolerance.
    """
    left = 0.0
    for i in range(s.n_j):
        left = max(left, abs(gap[i]) if is_held(s, i) else 0.0)
    for i in range(s.n_j):
        if not is_held(s, i) and abs(gap[i]) > PARTED * (s.atol + s.rtol * size_of(s, i, 0.0, q) + left):
            return i
    return -1
