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

import math
from typing import Any, NamedTuple

import numpy as np

from lcpstep.compiled import by_address
from lcpstep.dense import assign, factorise, solve

NEGLIGIBLE = 1e-7  # of a joint's mobility: a direction this stiff is another joint's, up to drift
EPSILON = 2.220446049250313e-16
REFINEMENTS = 20
SWEEPS = 30
REDUNDANT = 0  # place in `kind`: 1 where S is singular


@by_address
class Elimination(NamedTuple):
    """Work space for the joints of a step."""

    S: Any  # (n_j, n_j) scaled to unit diagonal
    B: Any  # (n_j, n_j) its symmetric part, while it is made diagonal
    F: Any  # its factors, or its eigenvectors in columns
    values: Any  # (n_j,) eigenvalues
    scale: Any  # (n_j,)
    pivots: Any  # (n_j,)
    kind: Any  # (1,)
    x: Any  # (n_j,) the solution
    y: Any
    r: Any
    d: Any
    Z: Any  # (2 n_c + 1, n_j) S^-1 times the columns of G_J A^-1 G^T and, last, the rates of v_free


def elimination(n_j: int, n_c: int) -> Elimination:
    """Work space for n_j joints and n_c contacts."""
    vectors = {name: np.zeros(n_j) for name in ("values", "scale", "x", "y", "r", "d")}
    integers = {"pivots": np.zeros(n_j, dtype=np.int64), "kind": np.zeros(1, dtype=np.int64)}
    S = np.zeros((n_j, n_j))
    return Elimination(S=S, B=S.copy(), F=S.copy(), Z=np.zeros((2 * n_c + 1, n_j)), **vectors, **integers)


def factorise_joints(e: Any, W: Any, first: int) -> None:
    """Take S from the rows and columns of W from `first` on, and factorise it."""
    n = len(e.scale)
    for i in range(n):
        s = W[first + i, first + i]
        e.scale[i] = 1.0 / math.sqrt(s) if s > 0.0 else 0.0
    for i in range(n):
        for j in range(n):
            e.S[i, j] = e.scale[i] * W[first + i, first + j] * e.scale[j]
    assign(e.F, e.S)
    e.kind[REDUNDANT] = 0
    regular = factorise(e.F, e.pivots)
    for i in range(n):
        regular = regular and abs(e.F[i, i]) > NEGLIGIBLE
    if not regular:
        e.kind[REDUNDANT] = 1
        diagonalise(e)


def diagonalise(e: Any) -> None:
    """Eigenvalues and eigenvectors of the symmetric part of S, by cyclic Jacobi rotations."""
    n, B, V = len(e.scale), e.B, e.F
    for i in range(n):
        for j in range(n):
            B[i, j] = 0.5 * (e.S[i, j] + e.S[j, i])
            V[i, j] = 1.0 if i == j else 0.0
    for _ in range(SWEEPS):
        off = 0.0
        for i in range(n):
            for j in range(i):
                off = max(off, abs(B[i, j]))
                rotate(B, V, j, i)
        if off <= EPSILON:
            break
    for i in range(n):
        e.values[i] = B[i, i]


def rotate(B: Any, V: Any, p: int, q: int) -> None:
    """Make B_pq zero by a rotation, which V collects."""
    if abs(B[p, q]) <= EPSILON * EPSILON:  # of the diagonal: its square would overflow below
        return
    tau = (B[q, q] - B[p, p]) / (2.0 * B[p, q])
    t = (1.0 if tau >= 0.0 else -1.0) / (abs(tau) + math.sqrt(1.0 + tau * tau))
    c = 1.0 / math.sqrt(1.0 + t * t)
    s = t * c
    for k in range(len(B)):
        B[k, p], B[k, q] = c * B[k, p] - s * B[k, q], s * B[k, p] + c * B[k, q]
    for k in range(len(B)):
        B[p, k], B[q, k] = c * B[p, k] - s * B[q, k], s * B[p, k] + c * B[q, k]
        V[k, p], V[k, q] = c * V[k, p] - s * V[k, q], s * V[k, p] + c * V[k, q]


def solve_joints(e: Any, out: Any) -> None:
    """Out <- S^-1 y for the right-hand side in e.y, refined; of least norm where S is singular."""
    n, before = len(e.scale), np.inf
    for i in range(n):
        e.y[i] *= e.scale[i]
        e.x[i], e.r[i] = 0.0, e.y[i]
    for _ in range(REFINEMENTS):
        apply_inverse(e)
        worst = largest = 0.0
        for i in range(n):
            e.x[i] += e.d[i]
        for i in range(n):
            e.r[i], size = e.y[i], abs(e.y[i])
            for j in range(n):
                e.r[i] -= e.S[i, j] * e.x[j]
                size += abs(e.S[i, j] * e.x[j])
            worst, largest = max(worst, abs(e.r[i])), max(largest, size)
        if worst <= EPSILON * largest or worst > 0.5 * before:
            break
        before = worst
    for i in range(n):
        out[i] = e.scale[i] * e.x[i]


def apply_inverse(e: Any) -> None:
    """d <- S^-1 r by the factors, or by those eigenvectors that belong to independent joints."""
    n = len(e.scale)
    assign(e.d, e.r)
    if e.kind[REDUNDANT] == 0:
        solve(e.F, e.pivots, e.d)
        return
    for i in range(n):
        e.d[i] = 0.0
    for k in range(n):
        if e.values[k] > NEGLIGIBLE:
            share = 0.0
            for i in range(n):
                share += e.F[i, k] * e.r[i]
            for i in range(n):
                e.d[i] += e.F[i, k] * share / e.values[k]


def eliminate(e: Any, W: Any, b: Any, ids: Any, n_a: int, n_k: int, R: Any, reduced: Any) -> None:
    """Problem of the contacts alone, R and `reduced`: rows ids[:n_a] of W and b without the joints ids[n_a:n_k].

    R = W - W_J S^-1 W_J^T row by row in one dimension; Z keeps what `joint_impulses` needs.
    """
    n_j = n_k - n_a
    if n_j > 0:
        factorise_joints(e, W, ids[n_a])
        for k in range(n_a + 1):
            for j in range(n_j):
                e.y[j] = W[ids[n_a + j], ids[k]] if k < n_a else b[ids[n_a + j]]
            solve_joints(e, e.Z[k])
    for i in range(n_a):
        reduced[i] = b[ids[i]]
        for j in range(n_j):
            reduced[i] -= W[ids[i], ids[n_a + j]] * e.Z[n_a, j]
        for k in range(n_a):
            total = W[ids[i], ids[k]]
            for j in range(n_j):
                total -= W[ids[i], ids[n_a + j]] * e.Z[k, j]
            R[i * n_a + k] = total


def joint_impulses(e: Any, ids: Any, n_a: int, n_k: int, p: Any) -> None:
    """Impulses of the joints ids[n_a:n_k] that belong to those of the contacts ids[:n_a], both in p."""
    for j in range(n_k - n_a):
        total = -e.Z[n_a, j]
        for k in range(n_a):
            total -= e.Z[k, j] * p[ids[k]]
        p[ids[n_a + j]] = total


def distribute(e: Any, solution: Any, ids: Any, n_a: int, n_k: int, p: Any) -> None:
    """Impulses of all rows; zero on those that take no part."""
    for i in range(len(p)):
        p[i] = 0.0
    for k in range(n_a):
        p[ids[k]] = solution[k]
    joint_impulses(e, ids, n_a, n_k, p)
