"""Linear complementarity problems: find z >= 0 with w = W z + b >= 0 and z^T w = 0.

`solve_lcp` solves one, `solve_lcp_batch` many small ones; `residual` judges any z, whoever found it. Steppers
call `lcpstep.lcp.kernel.solve_small` from compiled code. Nothing here knows mechanics, and importing it loads
numpy only.
"""

from lcpstep.lcp.batch import BatchSolution, solve_lcp_batch
from lcpstep.lcp.judged import residual
from lcpstep.lcp.problem import LCP, Ray, Solution
from lcpstep.lcp.solve import check_method, solve_lcp
from lcpstep.lcp.status import Status

__all__ = [
    "LCP",
    "BatchSolution",
    "Ray",
    "Solution",
    "Status",
    "check_method",
    "residual",
    "solve_lcp",
    "solve_lcp_batch",
]
