"""A problem in units of its own: rows and columns scaled by powers of two to entries of like size on average.

What `scaling` does at every problem, in two passes, brings the largest entries near one; of a matrix whose columns
are of units far apart it leaves rows that are small throughout, and what is told from them depends on the units. The
scaling that makes the sum of the squared logarithms of all entries least does not (A. R. Curtis, J. K. Reid, J. Inst.
Maths Applics 10 (1972) 118). It costs more and is misled by entries that are nothing but rounding, so it is for what
the other has not decided.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from lcpstep.lcp.problem import Ray, Solution

ROUNDS = 40  # of rows and columns in turn; a matrix without zeros takes one


class Balanced(NamedTuple):
    """R W C and R b, R = 2^rows and C = 2^columns: z of the problem itself is C z, w is R^-1 w."""

    W: Any
    b: Any
    rows: Any
    columns: Any


def balanced(W: Any, b: Any) -> Balanced | None:
    """The balanced problem for a dense W; None where it is the problem itself or its numbers would not be exact."""
    some = W != 0.0
    logarithms = np.where(some, np.frexp(W)[1], 0).astype(float)
    of_rows, of_columns = np.maximum(some.sum(axis=1), 1), np.maximum(some.sum(axis=0), 1)
    rows, columns = np.zeros(len(b)), np.zeros(len(b))
    for _ in range(ROUNDS):
        before = columns
        rows = -(some * (logarithms + columns)).sum(axis=1) / of_rows
        columns = -(some * (logarithms + rows[:, None])).sum(axis=0) / of_columns
        if np.max(np.abs(columns - before), initial=0.0) < 0.5:
            break
    r, c = np.rint(rows).astype(int), np.rint(columns).astype(int)
    if not (r.any() or c.any()):
        return None
    with np.errstate(over="ignore", under="ignore"):
        V, q = np.ldexp(np.ldexp(W, r[:, None]), c), np.ldexp(b, r)
        exact = np.array_equal(np.ldexp(np.ldexp(V, -c), -r[:, None]), W)
        exact = exact and np.array_equal(np.ldexp(q, -r), b)
    return Balanced(V, q, r, c) if exact else None


def in_units(own: Balanced, solution: Solution) -> Solution:
    """What was found for the balanced problem, in the units of the problem itself."""
    found, certificate = solution.certificate, None
    if isinstance(found, Ray):
        z, dz, d = (
            np.ldexp(x, k) for x, k in ((found.z, own.columns), (found.dz, own.columns), (found.d, -own.rows))
        )
        certificate = Ray(z, dz, found.z_0, found.dz_0, d)
    elif found is not None:
        certificate = np.ldexp(found, own.rows)
    z, w = np.ldexp(solution.z, own.columns), np.ldexp(solution.w, -own.rows)
    return solution._replace(z=z, w=w, certificate=certificate)
