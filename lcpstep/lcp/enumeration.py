"""Every complementary basis in turn: the method that finds a solution of a tiny problem whenever a basis has one.

The 2^n sets of positive z are tried in the order of binary counting; each answer is refined and judged.
"""

from __future__ import annotations

from typing import Any

from lcpstep.lcp.judge import judge
from lcpstep.lcp.principal import judge_clipped, list_chosen, solve_active
from lcpstep.lcp.status import FAILED, MAX_ITERATIONS, SOLVED
from lcpstep.lcp.workspace import CHOSEN, SIZE, SLACK


def enumerate_bases(W: Any, b: Any, z: Any, tolerance: float, limit: int, work: Any) -> int:
    """Try at most `limit` bases of the scaled problem in work; SOLVED, FAILED if none passes, or the limit."""
    n = b.shape[0]
    work.indices[CHOSEN, :n] = 0
    for _ in range(limit):
        work.report[1] += 1.0
        if solve_active(z, list_chosen(n, work), work):
            work.report[0] = judge(W, b, z, work.vectors[SLACK], work.vectors[SIZE])
            if work.report[0] <= tolerance and judge_clipped(W, b, z, tolerance, work) == SOLVED:
                return SOLVED
        if not count_up(n, work):
            return FAILED
    return MAX_ITERATIONS


def count_up(n: int, work: Any) -> bool:
    """The next set in binary counting; False after the last."""
    for i in range(n):
        work.indices[CHOSEN, i] = 1 - work.indices[CHOSEN, i]
        if work.indices[CHOSEN, i] == 1:
            return True
    return False
