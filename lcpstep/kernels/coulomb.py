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

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.kernels.vectors import clear, copy, largest
from lcpstep.lcp.kernel import solve_small
from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import Doubles, abs, after, max, min
from lcpstep.shelf import Shelf

DEGENERATE = 1e-13  # determinant, relative to its terms, below which normal and tangent are one direction
ROUNDING = 1e-13  # relative: a sliding velocity this small has no sign
FAST = 1e4  # times an approach: sliding that impulses of its size hardly change
SOLVED = 0


class ContactProblem:
    """The contacts of a step or an event, the joints eliminated, and where their complementarity problem is written.

    mobility, rate, impulse    of m = n_a contacts and n_f tangents: (m, m), (m,), (m,); normals first; rates are
                               velocities or, of forces in the place of impulses, accelerations without any;
                               the rates of joints follow until they are eliminated
    mu : (n_c,)
    ids      rows that take part; the first are the contacts'
    carrier  place in `ids` of the normal of each tangent
    warm     the impulses of the last problem are a guess for the next; without one, a problem with several solutions
             has the same whatever came before
    again    with friction: the problem is the last one, hardly changed, and the impulses of that are a guess
    W, b, z  of the problem with friction;  fast : (n_c,)  sliding velocities that another problem has slower
    slow, made, sum    of impacts in turn, see `energetic`: speeds below which contacts have no restitution, and what
                 forces have made of their approaches, (n_c,) each; impulses of those before (2 n_c,)

    Parameters
    ----------
    mu : (n_c,);  frictional : bool;  n : rows of a step;  warm : bool
    """

    def __init__(self, mu: Any, frictional: bool, n: int, warm: bool) -> None:
        n_c = len(mu)
        unknowns = 4 * n_c if frictional else 0
        self.arrays = {
            "mobility": np.zeros(4 * n_c * n_c),
            "rate": np.zeros(n),
            "impulse": np.zeros(2 * n_c),
            "mu": mu,
        }
        self.mobility, self.rate = doubles(self.arrays["mobility"]), doubles(self.arrays["rate"])
        self.impulse, self.mu = doubles(self.arrays["impulse"]), doubles(mu)
        self.space = np.zeros(unknowns * unknowns + 2 * unknowns + 5 * n_c)
        x = Shelf(self.space)
        self.W, self.b, self.z = x.take(unknowns * unknowns), x.take(unknowns), x.take(unknowns)
        self.slow, self.fast, self.made, self.sum = x.take(n_c), x.take(n_c), x.take(n_c), x.take(2 * n_c)
        self.lists = np.zeros(n, dtype=np.intp), np.zeros(n_c, dtype=np.intp)
        self.ids, self.carrier = indices(self.lists[0]), indices(self.lists[1])
        largest = unknowns if unknowns > n_c else n_c
        self.warm, self.again, self.work = warm, False, Workspace(largest if largest > 0 else 1)


def solve_contacts(c: ContactProblem, n_a: int, n_f: int) -> bool:
    """Impulses of n_a contacts, the frictional n_f of them, from c.mobility and c.rate into c.impulse."""
    if n_f == 0:
        return solve_normals(c, n_a)
    if n_a == 1 and solve_frictional(c.mobility, c.rate, c.mu[c.ids[0]], c.impulse):
        return True
    return solve_three_rows(c, n_a, n_f) or solve_four_rows(c, n_a, n_f) or solve_slowed(c, n_a, n_f)


def solve_normals(c: ContactProblem, n_a: int) -> bool:
    """Contacts without friction: one by a division, several by the solver."""
    if n_a == 1 and c.mobility[0] > 0.0:
        c.impulse[0] = max(0.0, -c.rate[0] / c.mobility[0])
        return True
    if not c.warm:
        clear(c.impulse, n_a)
    return solve_small(c.mobility, c.rate, c.impulse, n_a, c.work) == SOLVED


def solve_frictional(R: Doubles, b: Doubles, mu: float, p: Doubles) -> bool:
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


def solve_three_rows(c: ContactProblem, n_a: int, n_f: int) -> bool:
    """Unknowns p_N of all contacts, then p_R and xi_L of the frictional ones."""
    m, n = n_a + n_f, n_a + 2 * n_f
    begin(c, m, n)
    for f in range(n_f):
        k, T = c.carrier[f], n_a + f
        mu = c.mu[c.ids[k]]
        for i in range(m):
            c.W[i * n + k] -= c.mobility[i * m + T] * mu
        c.W[T * n + m + f] = 1.0
        c.W[(m + f) * n + k], c.W[(m + f) * n + T] = 2.0 * mu, -1.0
    if solve_small(c.W, c.b, c.z, n, c.work) != SOLVED:
        return False
    copy(c.impulse, c.z, m)
    for f in range(n_f):
        k, T = c.carrier[f], n_a + f
        limit = c.mu[c.ids[k]] * c.z[k]
        c.impulse[T] = max(-limit, min(limit, c.z[T] - limit))
    return True


def solve_four_rows(c: ContactProblem, n_a: int, n_f: int) -> bool:
    """Unknowns p_N of all contacts, then p_T+, p_T- and the slack of the frictional ones."""
    m, n = n_a + n_f, n_a + 3 * n_f
    begin(c, m, n)
    for f in range(n_f):
        k, T, L, slack = c.carrier[f], n_a + f, m + f, m + n_f + f
        for i in range(m):
            c.W[i * n + L], c.W[L * n + i] = -c.mobility[i * m + T], -c.mobility[T * m + i]
        c.b[L] = -c.b[T]
        c.W[T * n + slack] = c.W[L * n + slack] = 1.0
        c.W[slack * n + k], c.W[slack * n + T], c.W[slack * n + L] = c.mu[c.ids[k]], -1.0, -1.0
    for f in range(n_f):
        for g in range(n_f):
            c.W[(m + f) * n + m + g] = c.mobility[(n_a + f) * m + n_a + g]
    if solve_small(c.W, c.b, c.z, n, c.work) != SOLVED:
        return False
    copy(c.impulse, c.z, n_a)
    for f in range(n_f):
        limit = c.mu[c.ids[c.carrier[f]]] * c.z[c.carrier[f]]
        c.impulse[n_a + f] = max(-limit, min(limit, c.z[n_a + f] - c.z[m + f]))
    return True


def solve_slowed(c: ContactProblem, n_a: int, n_f: int) -> bool:
    """The same with slower sliding where that goes on all the same.

    Approaches may be so slow beside it, as at the end of a chattering, that both keep no digits in one problem.
    """
    most, found = FAST * largest(c.rate, 0.0, n_a), False
    for f in range(n_f):
        c.fast[f] = c.rate[n_a + f]
        c.rate[n_a + f] = max(-most, min(most, c.rate[n_a + f]))
        found = found or c.rate[n_a + f] != c.fast[f]
    found = found and (solve_three_rows(c, n_a, n_f) or solve_four_rows(c, n_a, n_f))
    for f in range(n_f):
        u, _ = motion_of(c, c.impulse, n_a + f, n_a + n_f)
        found = found and (c.rate[n_a + f] == c.fast[f] or u * c.fast[f] > 0.0)
    copy(after(c.rate, n_a), c.fast, n_f)
    return found


def motion_of(c: ContactProblem, p: Doubles, i: int, m: int) -> tuple[float, float]:
    """The velocity, or acceleration, of unknown i's row of m under impulses p, and the size of its terms."""
    u, size = c.rate[i], abs(c.rate[i])
    for k in range(m):
        u += c.mobility[i * m + k] * p[k]
        size += abs(c.mobility[i * m + k] * p[k])
    return u, size


def begin(c: ContactProblem, m: int, n: int) -> None:
    """A problem of n unknowns, the first m rows and columns those of the contacts, all else zero."""
    clear(c.W, n * n)
    clear(c.b, n)
    if not c.again:
        clear(c.z, n)
    for i in range(m):
        c.b[i] = c.rate[i]
        for k in range(m):
            c.W[i * n + k] = c.mobility[i * m + k]
