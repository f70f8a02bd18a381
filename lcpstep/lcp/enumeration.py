"""Every complementary basis in turn, for tiny problems: it finds a solution whenever a basis has one.

The 2^n sets of positive z are tried in the order of binary counting; each answer is refined and judged.
"""

from __future__ import annotations

import cython

from lcpstep.lcp.status import FAILED, MAX_ITERATIONS, SOLVED

if not cython.compiled:
    from lcpstep.lcp.principal import clip, solve_chosen
    from lcpstep.lcp.workspace import Workspace
    from lcpstep.pointers import Doubles


def enumerate_bases(
    W: Doubles, b: Doubles, z: Doubles, n: int, tolerance: float, limit: int, work: Workspace
) -> int:
    """Try at most `limit` bases: SOLVED by one of them, FAILED by all, or MAX_ITERATIONS."""
    for i in range(n):
        work.trial[i] = 0.0
    for subset in range(1 << n):
        if subset >= limit:
            return MAX_ITERATIONS
        for i in range(n):
            work.chosen[i] = (subset >> i) & 1
        work.iterations += 1
        if (
            solve_chosen(W, b, z, n, tolerance, work)
            and work.residual <= tolerance
            and clip(W, b, z, n, work) <= tolerance
        ):
            return SOLVED
    return FAILED
