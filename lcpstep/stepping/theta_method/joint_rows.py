"""Joints eliminated from a step: the rates that they take away, and the impulses that do it.

With the impulses p_J of the joints and p of the contacts, v+ = v_free + A^-1 (G_J^T p_J + G^T p), and

    S p_J = -(G_J v_free + g_t) - G_J A^-1 G^T p,        S = G_J A^-1 G_J^T, the joints' own Delassus matrix.

Joints that say the same thing twice make S singular. Then the impulses of least norm (each in the unit in which its
joint has unit mobility) are taken, by the eigenvectors of S; directions in which S is smaller than `NEGLIGIBLE` count
as said twice. What such joints contradict each other in stays as a rate, which the caller looks at.

Source: G. Golub, C. Van Loan, Matrix Computations, algorithms 3.4.1 and 8.5.3; F. Pfeiffer, C. Glocker, Multibody
Dynamics with Unilateral Contacts (Wiley 1996), chapter 4.
"""

from __future__ import annotations

from math import sqrt

import cython
import numpy as np

from lcpstep.arrays import indices
from lcpstep.kernels.linear import cancels, factorise, solve
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.vectors import add, clear, copy, largest, product, size_of_product
from lcpstep.pointers import Doubles, Indices, abs, after, inf, max
from lcpstep.shelf import Shelf
from lcpstep.stepping.steps import CONTRADICTION

NEGLIGIBLE = 1e-7  # of a joint's mobility: a direction this stiff is another joint's, up to drift
STALLED = 1e4  # of the slack: how much rounding in the gaps' own arithmetic may leave
NOTHING = 1e-12  # of the terms of a number: what is left of one
NEARLY = 1e-3  # of a mobility: what joints leave of it with digits enough
LOST = 3e-7  # of a row: what joints leave of it that has no digits for velocities
GRAIN = 1e-15 / CONTRADICTION  # of the largest impulse: to which the others are known
SMALLEST = 1e-290  # next to it numbers have all their digits
REFINEMENTS, SWEEPS = 20, 30
VECTORS = 6


class Elimination:
    """Work space for the joints of a step.

    n_j
    S : (n_j, n_j)   scaled to unit diagonal
    B : (n_j, n_j)   its symmetric part, while it is made diagonal
    F : (n_j, n_j)   its factors, or its eigenvectors in columns
    values, scale, x, y, r, d : (n_j,)   eigenvalues; units; the solution, its right-hand side, residual and change
    pivots : (n_j,)
    redundant        S is singular
    swept            P tells what joints leave of rows
    Z : (2 n_c + 1, n_j)   S^-1 times the columns of G_J A^-1 G^T and, last, the rates of v_free

    P : (2 n_c, n_q)       what joints leave of rows
    way, size : (n_q,)     and of what a row's impulse does; size of the terms of either

    Parameters
    ----------
    n_j, n_c, n_q : int   joints, contacts and coordinates
    """

    def __init__(self, n_j: int, n_c: int, n_q: int) -> None:
        self.numbers = np.zeros((3 * n_j + 2 * n_c + 1 + VECTORS) * n_j + (2 * n_c + 2) * n_q)
        self.integers, self.n_j = np.zeros(n_j, dtype=np.intp), n_j
        self.pivots, self.redundant, self.swept = indices(self.integers), False, False
        x = Shelf(self.numbers)
        self.S, self.B, self.F = x.take(n_j * n_j), x.take(n_j * n_j), x.take(n_j * n_j)
        self.Z, self.values, self.scale, self.x = (
            x.take((2 * n_c + 1) * n_j),
            x.take(n_j),
            x.take(n_j),
            x.take(n_j),
        )
        self.y, self.r, self.d, self.P = x.take(n_j), x.take(n_j), x.take(n_j), x.take(2 * n_c * n_q)
        self.way, self.size = x.take(n_q), x.take(n_q)


def factorise_joints(e: Elimination, W: Doubles, stride: int, first: int) -> None:
    """Take S from rows and columns of W (`stride` numbers a row) from `first` on, and factorise it."""
    n = e.n_j
    for i in range(n):
        s = W[(first + i) * stride + first + i]
        e.scale[i] = 1.0 / sqrt(s) if s > 0.0 else 0.0
    for i in range(n):
        for j in range(n):
            e.S[i * n + j] = e.scale[i] * W[(first + i) * stride + first + j] * e.scale[j]
    copy(e.F, e.S, n * n)
    e.redundant = False
    regular = factorise(e.F, e.pivots, n)
    for i in range(n):
        regular = regular and abs(e.F[i * n + i]) > NEGLIGIBLE
    if not regular:
        e.redundant = True
        diagonalise(e)


def diagonalise(e: Elimination) -> None:
    """Eigenvalues and eigenvectors of the symmetric part of S, by cyclic Jacobi rotations."""
    n = e.n_j
    B, V = e.B, e.F
    for i in range(n):
        for j in range(n):
            B[i * n + j] = 0.5 * (e.S[i * n + j] + e.S[j * n + i])
            V[i * n + j] = 1.0 if i == j else 0.0
    for _ in range(SWEEPS):
        off = 0.0
        for i in range(n):
            for j in range(i):
                off = max(off, abs(B[i * n + j]))
                rotate(B, V, j, i, n)
        if off <= RESOLUTION:
            break
    for i in range(n):
        e.values[i] = B[i * n + i]


def rotate(B: Doubles, V: Doubles, p: int, q: int, n: int) -> None:
    """Make B_pq zero by a rotation, which V collects."""
    if abs(B[p * n + q]) <= RESOLUTION * RESOLUTION:  # of the diagonal: its square would overflow below
        return
    tau = (B[q * n + q] - B[p * n + p]) / (2.0 * B[p * n + q])
    t = (1.0 if tau >= 0.0 else -1.0) / (abs(tau) + sqrt(1.0 + tau * tau))
    c = 1.0 / sqrt(1.0 + t * t)
    s = t * c
    for k in range(n):
        B[k * n + p], B[k * n + q] = c * B[k * n + p] - s * B[k * n + q], s * B[k * n + p] + c * B[k * n + q]
    for k in range(n):
        B[p * n + k], B[q * n + k] = c * B[p * n + k] - s * B[q * n + k], s * B[p * n + k] + c * B[q * n + k]
        V[k * n + p], V[k * n + q] = c * V[k * n + p] - s * V[k * n + q], s * V[k * n + p] + c * V[k * n + q]


def solve_joints(e: Elimination, out: Doubles) -> None:
    """Out <- S^-1 y for the right-hand side in e.y, refined; of least norm where S is singular."""
    n = e.n_j
    before = inf
    for i in range(n):
        e.y[i] *= e.scale[i]
        e.x[i], e.r[i] = 0.0, e.y[i]
    for _ in range(REFINEMENTS):
        apply_inverse(e)
        worst = largest = 0.0
        add(e.x, 1.0, e.d, n)
        for i in range(n):
            e.r[i], size = e.y[i], abs(e.y[i])
            for j in range(n):
                e.r[i] -= e.S[i * n + j] * e.x[j]
                size += abs(e.S[i * n + j] * e.x[j])
            worst, largest = max(worst, abs(e.r[i])), max(largest, size)
        if worst <= RESOLUTION * largest or worst > 0.5 * before:
            break
        before = worst
    for i in range(n):
        out[i] = e.scale[i] * e.x[i]


def apply_inverse(e: Elimination) -> None:
    """d <- S^-1 r by the factors, or by those eigenvectors that belong to independent joints."""
    n = e.n_j
    copy(e.d, e.r, n)
    if not e.redundant:
        solve(e.F, e.pivots, e.d, n)
        return
    clear(e.d, n)
    for k in range(n):
        if e.values[k] > NEGLIGIBLE:
            share = 0.0
            for i in range(n):
                share += e.F[i * n + k] * e.r[i]
            for i in range(n):
                e.d[i] += e.F[i * n + k] * share / e.values[k]


def eliminate(
    e: Elimination, W: Doubles, n: int, H: Doubles, X: Doubles, n_q: int, ids: Indices, n_a: int, n_k: int,
    R: Doubles, rate: Doubles,
) -> None:  # fmt: skip
    """Problem of the contacts ids[:n_a] alone, from the n rows and rates of all, without the joints ids[n_a:n_k].

    W = H X^T are the mobilities of all; R = W - W_J S^-1 W_J^T, n_a numbers a row, those of the contacts. The rates
    change in place; Z keeps what `distribute` needs.
    """
    n_j = n_k - n_a
    if n_j > 0:
        factorise_joints(e, W, n, ids[n_a])
        for k in range(n_a + 1):
            for j in range(n_j):
                e.y[j] = W[ids[n_a + j] * n + ids[k]] if k < n_a else rate[n_a + j]
            solve_joints(e, after(e.Z, k * n_j))
    e.swept = False
    for i in range(n_a):
        for j in range(n_j):
            rate[i] -= W[ids[i] * n + ids[n_a + j]] * e.Z[n_a * n_j + j]
        for k in range(n_a):
            total = W[ids[i] * n + ids[k]]
            for j in range(n_j):
                total -= W[ids[i] * n + ids[n_a + j]] * e.Z[k * n_j + j]
            R[i * n_a + k] = total
        e.swept = e.swept or not R[i * n_a + i] > NEARLY * W[ids[i] * n + ids[i]]
    if e.swept and n_j > 0:
        sweep_out(e, H, X, n_q, ids, n_a, n_j, R)
    for i in range(n_a):
        for k in range(n_a):
            both, own = R[i * n_a + k], R[i * n_a + i] * R[k * n_a + k]
            if both != 0.0 and cancels(both, own, after(H, ids[i] * n_q), after(X, ids[k] * n_q), n_q):
                R[i * n_a + k] = 0.0


def sweep_out(
    e: Elimination, H: Doubles, X: Doubles, n_q: int, ids: Indices, n_a: int, n_j: int, R: Doubles
) -> None:
    """R of what joints leave of rows, P_k = H_k - sum Z_kj H_j, and of X so: R as a difference has no digits."""
    first = ids[n_a] * n_q  # of the joints' rows, which follow each other
    for k in range(n_a):
        leave(e, after(H, ids[k] * n_q), after(H, first), after(e.Z, k * n_j), n_q, after(e.P, k * n_q))
    for k in range(n_a):
        leave(e, after(X, ids[k] * n_q), after(X, first), after(e.Z, k * n_j), n_q, e.way)
        for i in range(n_a):
            R[i * n_a + k] = product(e.P, e.way, i, n_q)


def leave(e: Elimination, row: Doubles, J: Doubles, share: Doubles, n_q: int, out: Doubles) -> None:
    """What joints leave of a row, with that share of each of theirs; rounding of the largest is nothing."""
    most = 0.0  # shares are known to the rounding of the largest, in the units in which joints have unit mobility
    for j in range(e.n_j):
        most = max(most, abs(share[j]) / e.scale[j] if e.scale[j] > 0.0 else 0.0)
    for q in range(n_q):
        out[q], e.size[q] = row[q], abs(row[q])
    for j in range(e.n_j):
        part, of = -share[j], after(J, j * n_q)
        for q in range(n_q if most > 0.0 else 0):
            out[q] += part * of[q]
            e.size[q] += e.scale[j] * most * abs(of[q])
    for q in range(n_q):
        out[q] = 0.0 if abs(out[q]) <= NOTHING * e.size[q] else out[q]


def lost(e: Elimination, H: Doubles, n_q: int, i: int, k: int) -> bool:
    """Whether of the k-th contact's row, H_i, so little is left that its impulse is not known."""
    if not e.swept:
        return False
    left, whole = largest(after(e.P, k * n_q), 0.0, n_q), largest(after(H, i * n_q), 0.0, n_q)
    return 0.0 < left < LOST * whole


def distribute(
    e: Elimination, solution: Doubles, ids: Indices, n_a: int, n_k: int, p: Doubles, n: int
) -> None:
    """Impulses p of all n rows: those of the contacts ids[:n_a], and of the joints ids[n_a:n_k] that go with them."""
    n_j = n_k - n_a
    clear(p, n)
    for k in range(n_a):
        p[ids[k]] = solution[k]
    for j in range(n_j):
        total = -e.Z[n_a * n_j + j]
        for k in range(n_a):
            total -= e.Z[k * n_j + j] * p[ids[k]]
        p[ids[n_a + j]] = total


def arrived(worst: float, before: float, slack: float, G: Doubles, n: int, q: Doubles, n_q: int) -> bool:
    """Whether Newton's iteration for positions is at its end: gaps within the slack, or no smaller for rounding.

    The slack is that of a step; rounding is that of the terms G q of n gaps as well, wherever the motion has gone.
    """
    if worst <= slack or not 0.5 * before < worst:
        return worst <= slack
    for k in range(n):
        slack = max(slack, RESOLUTION * size_of_product(G, q, k, n_q))
    return worst <= STALLED * slack


def joints_hold(
    J: Doubles, J_t: Doubles, J_start: Doubles, n_j: int, v: Doubles, v_free: Doubles, v_next: Doubles, n_q: int,
    X: Doubles, p: Doubles, n: int, turning: float, failed: Indices,
) -> bool:  # fmt: skip
    """Whether the joints' rates are zero after the step; marks those for which they are not.

    Redundant joints agree on the joints' positions only, so what the joints turn by in the step is granted. What
    the impulses p of all n rows change a velocity by, X^T p, counts to its size: with unequal masses it is much more
    than the rest. Impulses are known to the rounding of the largest: where friction has nothing to hold, its own are
    that rounding, and so are the velocities; from step to step they shrink to numbers without digits.
    """
    hold, most = True, GRAIN * largest(p, 0.0, n)
    for j in range(n_j):
        rate, size, turned = J_t[j], abs(J_t[j]), 0.0
        for i in range(n_q):
            row = J[j * n_q + i]
            rate += row * v_next[i]
            speed = max(max(max(abs(v_next[i]), abs(v[i])), abs(v_free[i])), SMALLEST)
            steepest = 0.0
            for k in range(n):
                steepest = max(steepest, abs(X[k * n_q + i]))
                speed = max(speed, abs(X[k * n_q + i] * p[k]))
            size += abs(row) * max(speed, steepest * most)
            turned += abs(row - J_start[j * n_q + i]) * speed
        failed[j] = 0 if abs(rate) <= CONTRADICTION * size + turning * turned else 1
        hold = hold and failed[j] == 0
    return hold
