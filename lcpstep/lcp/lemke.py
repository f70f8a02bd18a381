"""Lemke's complementary pivoting on the scaled problem, with lexicographic anti-cycling.

The problem is widened by a covering variable z_0 >= 0,

    w = W z + b + d z_0,    d > 0,

so that z = 0 with z_0 large is feasible; z_0 is driven out while z_i w_i = 0 stays true for every i: the
complement of the variable that left enters next. Ties are broken as if b were b + (e, e^2, ..., e^n) for an
infinitesimal e, so no basis comes twice. It ends when z_0 leaves (solved) or when nothing bounds the entering
variable (a ray). C. E. Lemke, Management Sci. 11 (1965) 681; R. W. Cottle, J.-S. Pang, R. E. Stone, The
Linear Complementarity Problem (1992), section 4.4. It may start from any complementary basis, not only z = 0;
then d is chosen for that basis.

Variables are numbered z_0..z_(n-1) = 0..n-1, the covering variable n, w_i = n + 1 + i.
"""

from __future__ import annotations

import cython

from lcpstep.lcp.basis import pivot, refactorise, set_direction
from lcpstep.lcp.status import FAILED, MAX_ITERATIONS, RAY, SOLVED
from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import abs, after, inf, max, min
from lcpstep.rows import excesses, largest_entry, lowest_entry, ratios, subtract

TIE = 1e-13  # values this close, relative to the largest basic value, reach zero together
NOTHING = -1


def lemke(n: int, max_pivots: int, smallest: float, keep: bool, work: Workspace) -> int:
    """Pivot from the basis marked in `chosen` to a complementary one, which is marked there; returns a status.

    No pivot is smaller than `smallest`, relative to the largest entry of its direction. If `keep`, a ray is
    stored in the work arrays.
    """
    m, entering = start(n, work), n
    if m < 0:
        return FAILED
    for _ in range(max_pivots):
        set_direction(entering, m, n, work)
        if work.z_place[n] < 0:
            leaving = first_leaving(m, n, work)
        else:
            leaving = ratio_test(m, n, smallest, work)
        if leaving == NOTHING:
            if keep:
                keep_ray(entering, m, n, work)
            return RAY
        m = advance(entering, leaving, m, n, work)
        work.iterations += 1
        if leaving == n:
            for j in range(n):
                work.chosen[j] = 1 if work.z_place[j] >= 0 else 0
            return SOLVED
        entering = leaving + n + 1 if leaving < n else leaving - n - 1
    return MAX_ITERATIONS


def start(n: int, work: Workspace) -> int:
    """The basis of the chosen z and the other w; returns the number of z, -1 if the basis is singular.

    The covering vector is such that every basic variable grows by one with z_0: all ones for the basis of w.
    """
    m, basic, d = 0, work.basic, after(work.columns, n * n)
    for i in range(n):
        work.z_place[i], work.w_place[i] = NOTHING, NOTHING
        if work.chosen[i]:
            work.z_place[i], work.w_place[i] = m, m
            basic[m], work.tight[m] = i, i
            m += 1
    work.z_place[n] = -1
    if not refactorise(m, n, work):
        return -1
    for i in range(n):
        d[i] = 0.0 if work.chosen[i] else 1.0
    for q in range(m):
        subtract(d, after(work.columns, basic[q] * n), 1.0, n)
    return m


def first_leaving(m: int, n: int, work: Workspace) -> int:
    """The variable that the covering one, falling from infinity, reaches first; the last of equal ones."""
    x, dx, w, dw = work.x, work.dx, work.slack, work.dslack
    lowest, leaving = inf, NOTHING
    for q in range(m):
        if x[q] / dx[q] <= lowest:
            lowest, leaving = x[q] / dx[q], work.basic[q]
    for i in range(n):
        if work.w_place[i] < 0 and w[i] / dw[i] <= lowest:
            lowest, leaving = w[i] / dw[i], n + 1 + i
    return leaving


def ratio_test(m: int, n: int, smallest: float, work: Workspace) -> int:
    """The basic variable that bounds the entering one, lexicographically; the covering variable if it can."""
    bound = first_zero(m, n, smallest, work)
    if bound == inf:
        return NOTHING
    tied = list_ties(bound, m, n, work)
    for t in range(tied):
        if work.tied[t] == n:
            return n
    j = 0
    while tied > 1 and j < n:
        tied = keep_lowest(j, tied, m, n, work)
        j += 1
    return work.tied[0]


def first_zero(m: int, n: int, smallest: float, work: Workspace) -> float:
    """Growth of the entering variable at which a basic one is surely zero; infinite if none falls.

    Leaves in `smallest` the size above which a component of the direction counts.
    """
    x, dx, w, dw, trial = work.x, work.dx, work.slack, work.dslack, work.trial
    smallest *= max(1.0, max(largest_entry(dx, m), largest_entry(dw, n)))
    slack = TIE * max(largest_entry(x, m), largest_entry(w, n))
    ratios(trial, x, slack, dx, smallest, m)
    bound = lowest_entry(trial, m)
    ratios(trial, w, slack, dw, smallest, n)
    work.smallest = smallest
    return min(bound, lowest_entry(trial, n))


def list_ties(bound: float, m: int, n: int, work: Workspace) -> int:
    """List in `tied` the variables that reach zero within the bound; returns how many."""
    listed, trial, tied = work.tied, work.trial, 0
    excesses(trial, work.x, bound, work.dx, work.smallest, m)
    for q in range(m):
        if trial[q] <= 0.0:
            listed[tied] = work.basic[q]
            tied += 1
    excesses(trial, work.slack, bound, work.dslack, work.smallest, n)
    for i in range(n):
        if trial[i] <= 0.0:
            listed[tied] = n + 1 + i
            tied += 1
    return tied


def keep_lowest(j: int, tied: int, m: int, n: int, work: Workspace) -> int:
    """Of the tied variables keep those whose coefficient of e^(j+1), over the pivot, is lowest."""
    listed, lowest, kept = work.tied, inf, 0
    for t in range(tied):
        lowest = min(lowest, perturbation(listed[t], j, m, n, work))
    for t in range(tied):
        if perturbation(listed[t], j, m, n, work) <= lowest + TIE * max(1.0, abs(lowest)):
            listed[kept] = listed[t]
            kept += 1
    return kept


def perturbation(variable: int, j: int, m: int, n: int, work: Workspace) -> float:
    """Coefficient of e^(j+1) in the ratio of a basic variable: how b_j moves it, over its pivot."""
    place = work.w_place[j]
    if variable <= n:
        q = work.z_place[variable]
        return work.inverse[q * n + place] / work.dx[q] if place >= 0 else 0.0
    i = variable - n - 1
    if place < 0:
        return -1.0 / work.dslack[i] if i == j else 0.0
    moved = 0.0
    for q in range(m):
        moved += work.columns[work.basic[q] * n + i] * work.inverse[q * n + place]
    return moved / work.dslack[i]


def advance(entering: int, leaving: int, m: int, n: int, work: Workspace) -> int:
    """Let the entering variable grow until the leaving one is zero, and exchange them."""
    x, dx, w, dw = work.x, work.dx, work.slack, work.dslack
    if leaving <= n:
        theta = -x[work.z_place[leaving]] / dx[work.z_place[leaving]]
    else:
        theta = -w[leaving - n - 1] / dw[leaving - n - 1]
    theta = max(theta, 0.0)
    for q in range(m):
        x[q] += theta * dx[q]
    for i in range(n):
        w[i] += theta * dw[i]
    m = pivot(entering, leaving, m, n, work)
    if entering <= n:
        x[work.z_place[entering]] = theta
    else:
        w[entering - n - 1] = theta
    if leaving > n:
        w[leaving - n - 1] = 0.0
    return m


def keep_ray(entering: int, m: int, n: int, work: Workspace) -> None:
    """Store the ray, in the units of W and b: z + t dz and z_0 + t dz_0 for t >= 0."""
    direction, begin = work.ray_direction, work.ray_start
    for i in range(n):
        direction[i], begin[i] = 0.0, 0.0
    work.ray_dz_0, work.ray_z_0 = 0.0, 0.0
    for q in range(m):
        j, dx, x = work.basic[q], max(work.dx[q], 0.0), max(work.x[q], 0.0)
        if j < n:
            direction[j], begin[j] = dx * work.column_scale[j], x * work.column_scale[j]
        else:
            work.ray_dz_0, work.ray_z_0 = dx, x
    if entering < n:
        direction[entering] = work.column_scale[entering]
