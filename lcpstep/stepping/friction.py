"""Planar Coulomb friction of the closed contacts as a linear complementarity problem.

For every contact with a normal impulse p_N >= 0 and a tangential one |p_T| <= mu p_N,

    xi = u+ + r u      on normal and tangent (the average velocity of an impact, times 1 + r)
    0 <= xi_N  complementary to  p_N >= 0,      p_T = -mu p_N sign(xi_T)  where xi_T != 0

One contact is tried open, sticking, sliding either way. For several, the unknowns are p_N, p_R = p_T + mu p_N and
xi_L = max(0, -xi_T), with xi_R = max(0, xi_T) and p_L = mu p_N - p_T as their complements,

    xi_N = (W_NN - W_NT mu) p_N + W_NT p_R          + b_N
    xi_R = (W_TN - W_TT mu) p_N + W_TT p_R  +  xi_L + b_T
    p_L  =           2 mu   p_N -      p_R

and where the solver does not end there, p_N, p_T+, p_T- and a slack: one row more, but Lemke's method is known to
solve it whenever the contacts' own motion allows a solution.

Sources: C. Glocker, F. Pfeiffer, Nonlinear Dynamics 7 (1995) 471; M. Anitescu, F. Potra, Nonlinear Dynamics 14
(1997) 231; J. J. Moreau (CISM 302, 1988) for the law of impact.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address, call_solver

DEGENERATE = 1e-13  # determinant, relative to its terms, below which normal and tangent are one direction
ROUNDING = 1e-13  # relative: a sliding velocity this small has no sign


@by_address
class Problem(NamedTuple):
    """The contacts of a step, the joints eliminated, and where their complementarity problem is written."""

    R: Any  # (4 n_c^2,) mobilities, row by row
    reduced: Any  # (2 n_c,) rates
    solution: Any  # (2 n_c,) impulses: normals, then tangents
    mu: Any  # (n_c,)
    ids: Any  # rows that take part; the first are the contacts
    carrier: Any  # (n_c,) place in `ids` of the normal of each tangent
    W: Any
    b: Any
    z: Any
    solver: Any  # the complementarity solver, a function or its address
    work: Any  # its work space


def solve_contacts(c: Any, n_a: int, n_f: int) -> bool:
    """Impulses of n_a contacts, the frictional n_f of them, from c.R and c.reduced into c.solution."""
    if n_a == 1 and n_f == 1 and solve_frictional(c.R, c.reduced, c.mu[c.ids[0]], c.solution):
        return True
    if n_a == 1 and n_f == 0 and c.R[0] > 0.0:
        c.solution[0] = max(0.0, -c.reduced[0] / c.R[0])
        return True
    if solve_three_rows(c, n_a, n_f):
        return True
    return n_f > 0 and solve_four_rows(c, n_a, n_f)


def solve_frictional(R: Any, b: Any, mu: float, p: Any) -> bool:
    """One contact: open, sticking, or sliding either way; False if none of these fits."""
    p[0] = p[1] = 0.0
    if b[0] >= 0.0:
        return True
    W_NN, W_NT, W_TN, W_TT = R[0], R[1], R[2], R[3]
    determinant = W_NN * W_TT - W_NT * W_TN
    if determinant > DEGENERATE * W_NN * W_TT:
        p[0] = (W_NT * b[1] - W_TT * b[0]) / determinant
        p[1] = (W_TN * b[0] - W_NN * b[1]) / determinant
        if p[0] >= 0.0 and abs(p[1]) <= mu * p[0]:
            return True
    for k in range(2):
        sign = 1.0 - 2.0 * k  # of the sliding velocity
        mobility = W_NN - sign * mu * W_NT
        if mobility > 0.0:
            p[0] = -b[0] / mobility
            p[1] = -sign * mu * p[0]
            slip = b[1] + W_TN * p[0] + W_TT * p[1]
            size = abs(b[1]) + abs(W_TN * p[0]) + abs(W_TT * p[1])
            if sign * slip >= -ROUNDING * size:
                return True
    return False


def solve_three_rows(c: Any, n_a: int, n_f: int) -> bool:
    """Unknowns p_N of all contacts, then p_R and xi_L of the frictional ones."""
    m, n, R = n_a + n_f, n_a + 2 * n_f, c.R
    W = c.W[: n * n].reshape((n, n))
    clear(W, c.b, c.z, n)
    for i in range(m):
        c.b[i] = c.reduced[i]
        for k in range(m):
            W[i, k] = R[i * m + k]
    for f in range(n_f):
        k, T = c.carrier[f], n_a + f
        mu = c.mu[c.ids[k]]
        for i in range(m):
            W[i, k] -= R[i * m + T] * mu
        W[T, m + f] = 1.0
        W[m + f, k], W[m + f, T] = 2.0 * mu, -1.0
    if call_solver(c.solver, W, c.b[:n], c.z[:n], c.work) != 0:
        return False
    for i in range(m):
        c.solution[i] = c.z[i]
    for f in range(n_f):
        k, T = c.carrier[f], n_a + f
        limit = c.mu[c.ids[k]] * c.z[k]
        c.solution[T] = max(-limit, min(limit, c.z[T] - limit))
    return True


def solve_four_rows(c: Any, n_a: int, n_f: int) -> bool:
    """Unknowns p_N of all contacts, then p_T+, p_T- and the slack of the frictional ones."""
    m, n, R = n_a + n_f, n_a + 3 * n_f, c.R
    W = c.W[: n * n].reshape((n, n))
    clear(W, c.b, c.z, n)
    for i in range(m):
        c.b[i] = c.reduced[i]
        for k in range(m):
            W[i, k] = R[i * m + k]
    for f in range(n_f):
        k, T, L, slack = c.carrier[f], n_a + f, m + f, m + n_f + f
        for i in range(m):
            W[i, L], W[L, i] = -R[i * m + T], -R[T * m + i]
        c.b[L] = -c.b[T]
        W[T, slack] = W[L, slack] = 1.0
        W[slack, k], W[slack, T], W[slack, L] = c.mu[c.ids[k]], -1.0, -1.0
    for f in range(n_f):
        for g in range(n_f):
            W[m + f, m + g] = R[(n_a + f) * m + n_a + g]
    if call_solver(c.solver, W, c.b[:n], c.z[:n], c.work) != 0:
        return False
    for i in range(n_a):
        c.solution[i] = c.z[i]
    for f in range(n_f):
        limit = c.mu[c.ids[c.carrier[f]]] * c.z[c.carrier[f]]
        c.solution[n_a + f] = max(-limit, min(limit, c.z[n_a + f] - c.z[m + f]))
    return True


def clear(W: Any, b: Any, z: Any, n: int) -> None:
    """Zeros; without a guess, a problem with several solutions has the same one whatever came before."""
    for i in range(n):
        b[i] = z[i] = 0.0
        for k in range(n):
            W[i, k] = 0.0
