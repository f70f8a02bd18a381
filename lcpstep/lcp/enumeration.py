"""Every complementary basis in turn, for tiny problems: it finds a solution whenever a basis has one.

The 2^n sets of positive z are tried in the order of binary counting; each answer is refined and judged.
"""

from __future__ import annotations

from typing import Any

from lcpstep.lcp.principal import clip, solve_chosen
from lcpstep.lcp.status import FAILED, MAX_ITERATIONS, SOLVED
from lcpstep.lcp.workspace import CHOSEN, ITERATIONS, RESIDUAL, TRIAL


def enumerate_bases(W: Any, b: Any, z: Any, tolerance: float, limit: int, work: Any) -> int:
    """Try at most `limit` bases: SOLVED by one of them, FAILED by all, or MAX_ITERATIONS."""
    n = b.shape[0]
    for i in range(n):
        work.vectors[TRIAL, i] = 0.0
    for subset in range(2**n):
        if subset >= limit:
            return MAX_ITERATIONS
        for i in range(n):
            work.indices[CHOSEN, i] = (subset >> i) & 1
        work.report[ITERATIONS] += 1.0
        if (
            solve_chosen(W, b, z, tolerance, work)
            and work.report[RESIDUAL] <= tolerance
            and clip(W, b, z, work) <= tolerance
        ):
            return SOLVED
    return FAILED
