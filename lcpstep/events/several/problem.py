"""The complementarity problem of a set of closed contacts, as kernels; joints are eliminated from it.

    0 <= W z + b  complementary to  z >= 0,      W = D_cc - D_cj D_jj^-1 D_jc

W is the Delassus matrix of the contacts on the joints; z are impulses (`impact`) or forces (`forces`). Opposite
contacts can make it a problem without an answer by as little as rounding of b; then b is lifted by it. Source: V.
Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 5.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import call_solver
from lcpstep.events.several.state import HELD_JOINTS, LCP_B, LCP_NOISE, LCP_Z, LOADED, MEMBERS
from lcpstep.lcp.status import SOLVED

CHECKED = 1e-10  # relative violation that an answer found without the solver may have


def solve_contacts(s: Any) -> bool:
    """Solve the members' problem with b in LCP_B; z, at least zero, into LCP_Z, and who carries a force.

    LCP_NOISE is the rounding of b. Where the solver fails (W has lost too many digits), all that could are said to
    carry one, with z = 0: an answer to be checked.
    """
    k = s.number[MEMBERS]
    z, b = s.contact[LCP_Z], s.contact[LCP_B]
    W = s.W[: k * k].reshape((k, k))
    for a in range(k):
        z[a] = 0.0
    contact_matrix(s, W)
    solved = bool(call_solver(s.solver, W, b[:k], z[:k], s.lcp) == SOLVED)
    if not solved:
        for a in range(k):
            b[a] += s.contact[LCP_NOISE, a]
            z[a] = 0.0
        solved = bool(call_solver(s.solver, W, b[:k], z[:k], s.lcp) == SOLVED)
    for a in range(k):
        z[a] = z[a] if solved else 0.0
        s.mode[LOADED, s.member[a]] = 1 if z[a] > 0.0 or not solved else 0
    return solved


def contact_matrix(s: Any, W: Any) -> None:
    """W of the member contacts; the joints must be the rows held."""
    n_j, k_j, k = len(s.J), s.number[HELD_JOINTS], s.number[MEMBERS]
    for a in range(k):
        i = n_j + s.member[a]
        for m in range(k_j):  # the rows of the Cholesky factor that follow the joints'
            total = s.D[i, s.row[m]]
            for j in range(m):
                total -= s.L[k_j + a, j] * s.L[m, j]
            s.L[k_j + a, m] = total / s.L[m, m]
        for b in range(a + 1):
            total = s.D[i, n_j + s.member[b]]
            for m in range(k_j):
                total -= s.L[k_j + a, m] * s.L[k_j + b, m]
            W[a, b] = W[b, a] = total
